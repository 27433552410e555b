/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#ifndef vpPictureFeed_h
#define vpPictureFeed_h

#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <visp3/vlp_localization/vpVlpLocalizer.h>
#include <visp3/vlp_robot/vpOdometry.h>
#include <visp3/vlp_sensor/vpFrameSource.h>

BEGIN_VISP_NAMESPACE

//! A picture, and what the localizer made of it.
struct VISP_EXPORT vpLocatedPicture {
  double timestamp = 0; // s, of the picture
  double known = 0;     // s, when its pose was there for the control loop
  double compute = 0;   // s, that the localizer took
  vpVlpLocation location;
  std::optional<vpVlpFilter> filter;         // of the localizer, after it
  std::shared_ptr<vpImage<unsigned char>> I; // for whoever shows it
};

//! Where a control loop gets located pictures from, without ever waiting for one.
class VISP_EXPORT vpPictureFeed
{
public:
  virtual ~vpPictureFeed() = default;

  //! For the localizer, each sample once, as soon as it is there.
  virtual void addOdometry(const vpOdometry &sample) = 0;

  //! The next picture whose pose is known by \e now, in the order of their times; nothing where there is
  //! none.
  virtual std::optional<vpLocatedPicture> next(double now) = 0;

  //! Why no more pictures come, in one line; empty as long as some may.
  virtual std::string ended() const { return ""; }
};

/*!
  A camera in a thread of its own: reads a frame, locates it, reads the next one. Frames that came while one
  was being located are the source's business: a camera hands out its newest.
*/
class VISP_EXPORT vpLivePictures : public vpPictureFeed
{
public:
  /*!
    Starts at once. \param now The clock of the frames' time stamps, s; it is asked from the thread.
    \param source Outlives this, and its next() returns, or throws, within a second or so.
  */
  vpLivePictures(vpFrameSource &source, vpVlpLocalizer localizer, std::function<double()> now);
  ~vpLivePictures() override;

  void addOdometry(const vpOdometry &sample) override;
  std::optional<vpLocatedPicture> next(double now) override;
  std::string ended() const override;

private:
  void run();
  bool locate(vpLocatedPicture &picture);

  vpFrameSource &m_source;
  vpVlpLocalizer m_localizer; // the thread's alone
  std::function<double()> m_now;
  mutable std::mutex m_mutex; // of what follows
  std::deque<vpOdometry> m_odometry;
  std::deque<vpLocatedPicture> m_pictures;
  std::string m_ended;
  bool m_stop = false;
  std::thread m_thread; // last: it uses all of the above
};

END_VISP_NAMESPACE

#endif
