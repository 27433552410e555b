/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpCalibrationOutput_h
#define vpCalibrationOutput_h

#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <visp3/vlp_calibration/vpLampBundle.h>
#include <visp3/vlp_evaluation/vpReportTable.h>

BEGIN_VISP_NAMESPACE

//! A point of a picture and how far it is from where it should be, px. Those of one group have one colour.
struct vpDrawnResidual {
  Eigen::Vector2d point;
  Eigen::Vector2d residual;
  size_t group = 0;
  bool used = true; // false: drawn grey
};

/*!
  All residuals over the picture, as lines from each point, enlarged so that a typical one is visible; the
  factor is written there. \param size px, of the picture.
*/
cv::Mat vpResidualPicture(cv::Size size, const std::vector<vpDrawnResidual> &residuals,
                          const std::string &title);

//! The residuals of a bundle, a colour for each lamp.
std::vector<vpDrawnResidual> vpResidualsOf(const vpBundleResult &result);

//! The rig parameters that were not held: value, step, standard deviation.
vpReportTable vpRigTable(const vpBundleResult &result, const vpRigVector &priors);

//! Warns where lamps that were to be held do not explain the pictures, and names the one farthest off.
void vpWarnOfInflatedMap(const vpBundleResult &result, const vpLampMap &map);

//! Covariance of the rig parameters as CSV, m, rad, px and share.
std::string vpCovarianceCsv(const vpBundleResult &result);

/*!
  The folder of --out: made where there is none. Files appear whole, one after the other, the rig last: where
  it is there, all is. \throw vpException (ioError) with one line where a file cannot be written.
*/
class vpCalibrationFolder
{
public:
  explicit vpCalibrationFolder(const std::string &folder);

  //! Refuses a folder --out in which what is written would replace an input. \throw vpException (badValue)
  static void check(const std::string &folder, const std::vector<std::string> &inputs);

  std::string operator/(const std::string &name) const;
  void write(const std::string &name, const std::string &text) const;

  //! rig.yaml, and its camera as camera.xml.
  void writeRig(vpVlpRig rig) const;

private:
  std::string m_folder;
};

END_VISP_NAMESPACE

#endif
