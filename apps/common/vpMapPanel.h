/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpMapPanel_h
#define vpMapPanel_h

#include <deque>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <visp3/vlp_core/vpLampMap.h>
#include <visp3/vlp_localization/vpVlpLocalizer.h>

BEGIN_VISP_NAMESPACE

class vpMapSheet;

/*!
  The map from above, x to the right and y up, on a grid with its metres: lamps, bright where the last frame
  shows them; the robot with its heading, in the colour of its state; its trail; the ellipse that holds x and
  y to 3 sigma.

  A small map is shown whole with the robot, a large one (more than 80 lamps) around the robot, with about 60
  lamps. What is shown stays where it is until the robot, or a lamp that it sees, leaves it.
*/
class vpMapPanel
{
public:
  size_t longestTrail = 600; // poses

  explicit vpMapPanel(const vpLampMap &map);

  //! A path that the robot is to drive, m; what is shown holds all of it.
  void setPath(const std::vector<Eigen::Vector2d> &places);

  //! Where the robot truly is, in simulation: drawn as a cross.
  void setTruth(const std::optional<vpHomogeneousMatrix> &wMb);

  //! One more frame.
  void add(const vpVlpLocation &location);

  /*!
    The map as of the last frame, BGR. \param unit Size of text and lines; 1 suits a panel of 400 pixels.
    Nothing where \e size leaves no room.
  */
  cv::Mat draw(cv::Size size, double unit) const;

  //! Where in such a picture a place (m) is, px, centres at integers.
  Eigen::Vector2d pixel(const Eigen::Vector2d &place, cv::Size size, double unit) const;

  //! m, what a picture shows at least.
  const Eigen::AlignedBox2d &view() const { return m_view; }

private:
  struct Pose {
    Eigen::Vector2d place; // m
    double yaw;            // rad
    Eigen::Matrix2d covariance;
    std::string state;
  };
  struct Step {
    Eigen::Vector2d place; // m
    std::string state;
    bool joined; // to the one before
  };

  void follow();
  vpMapSheet sheet(cv::Size size, double unit) const;
  int rank(size_t lamp) const;
  std::vector<size_t> shown(const vpMapSheet &sheet) const;
  void drawLamps(vpMapSheet &sheet, const std::vector<size_t> &lamps) const;
  void drawLabels(vpMapSheet &sheet, const std::vector<size_t> &lamps) const;
  void drawPath(vpMapSheet &sheet) const;
  void drawTrail(vpMapSheet &sheet) const;
  void drawTruth(vpMapSheet &sheet) const;
  void drawRobot(vpMapSheet &sheet) const;

  vpLampMap m_map;
  std::unordered_map<std::string, size_t> m_lampOf; // index into the map, by id
  Eigen::AlignedBox2d m_extent;                     // m, of all lamps
  double m_reach = 0;                               // m, that is shown around the robot; 0: all lamps are
  Eigen::AlignedBox2d m_view;                       // m
  std::unordered_map<size_t, bool> m_seen;          // lamps of the last frame: whether they count
  std::optional<Pose> m_pose;
  std::optional<Pose> m_other; // that explains the frame as well
  std::deque<Step> m_trail;
  std::vector<Eigen::Vector2d> m_path;    // m
  std::optional<Eigen::Vector2d> m_truth; // m
};

END_VISP_NAMESPACE

#endif
