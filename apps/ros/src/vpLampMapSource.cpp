/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampMapSource.h"

#include <cstdlib>
#include <string>

#include <unistd.h>

#include <visp3/core/vpException.h>

#include "vpRosNode.h"

namespace
{
//! A file that is gone with this.
class TemporaryFile
{
public:
  explicit TemporaryFile(const std::string &bytes)
  {
    const int file = mkstemp(m_name.data());
    const bool good =
        file >= 0 && write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
    if (file >= 0) {
      close(file);
    }
    if (!good) {
      unlink(m_name.c_str());
      throw vpException(vpException::ioError, m_name + ": cannot be written");
    }
  }
  ~TemporaryFile() { unlink(m_name.c_str()); }
  TemporaryFile(const TemporaryFile &) = delete;
  TemporaryFile &operator=(const TemporaryFile &) = delete;

  const std::string &name() const { return m_name; }

private:
  std::string m_name = "/tmp/lamp_map.XXXXXX";
};
} // namespace

vpLampMapSource::vpLampMapSource(ros::NodeHandle &nh, const ros::NodeHandle &own, const Use &use) : m_use(use)
{
  std::string file;
  if (own.getParam("lamps", file) && !file.empty()) {
    m_use(vpLampMap::load(file));
  } else {
    m_topic = nh.subscribe("/lamp_map", 1, &vpLampMapSource::read, this);
    ROS_INFO("%s: none; waits for /lamp_map", own.resolveName("lamps").c_str());
  }
}

void vpLampMapSource::read(const std_msgs::StringConstPtr &text) const
{
  vpHandle([&] {
    const TemporaryFile file(text->data); // which errors name; its lines are the text's
    m_use(vpLampMap::load(file.name()));
    ROS_INFO("/lamp_map: a new map");
  });
}
