/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <visp3/vlp_servo/vpPictureFeed.h>

#include <exception>
#include <utility>

#include <visp3/core/vpException.h>

BEGIN_VISP_NAMESPACE

vpLivePictures::vpLivePictures(vpFrameSource &source, vpVlpLocalizer localizer, std::function<double()> now)
    : m_source(source), m_localizer(std::move(localizer)), m_now(std::move(now)), m_thread([this] { run(); })
{
}

vpLivePictures::~vpLivePictures()
{
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_stop = true;
  }
  m_thread.join();
}

void vpLivePictures::addOdometry(const vpOdometry &sample)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_odometry.push_back(sample);
}

std::optional<vpLocatedPicture> vpLivePictures::next(double)
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  if (m_pictures.empty()) {
    return std::nullopt;
  }
  std::optional<vpLocatedPicture> picture(std::move(m_pictures.front()));
  m_pictures.pop_front();
  return picture;
}

std::string vpLivePictures::ended() const
{
  const std::lock_guard<std::mutex> lock(m_mutex);
  return m_ended;
}

void vpLivePictures::run()
{
  constexpr int most = 10; // frames in a row that cannot be read
  std::string ended = "the camera has no more frames";
  for (int failures = 0; failures < most;) {
    try {
      vpLocatedPicture picture;
      if (!locate(picture)) {
        break;
      }
      failures = 0;
      const std::lock_guard<std::mutex> lock(m_mutex);
      m_pictures.push_back(std::move(picture));
    } catch (const vpException &error) {
      ended = error.getStringMessage();
      ++failures;
    } catch (const std::exception &error) {
      ended = error.what();
      ++failures;
    }
  }
  const std::lock_guard<std::mutex> lock(m_mutex);
  m_ended = ended;
}

//! \return False where there is nothing more to do.
bool vpLivePictures::locate(vpLocatedPicture &picture)
{
  vpVlpFrame frame;
  const bool more = m_source.next(frame);
  std::deque<vpOdometry> odometry;
  {
    const std::lock_guard<std::mutex> lock(m_mutex);
    if (!more || m_stop) {
      return false;
    }
    odometry.swap(m_odometry);
  }
  const double begin = m_now();
  for (const vpOdometry &sample : odometry) {
    m_localizer.filter.addOdometry(sample);
  }
  picture.timestamp = frame.timestamp;
  picture.location = m_localizer.process(frame);
  picture.filter = m_localizer.filter;
  picture.I = std::make_shared<vpImage<unsigned char>>(std::move(frame.I));
  picture.known = m_now();
  picture.compute = picture.known - begin;
  return true;
}

END_VISP_NAMESPACE
