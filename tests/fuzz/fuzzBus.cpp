/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include <cmath>
#include <memory>

#include <visp3/vlp_robot/vpRobotTurtleBot3.h>

#include "fuzz/vpFuzzBytes.h"
#include "fuzz/vpFuzzTarget.h"
#include "opencr/vpEmulatedTurtleBot3.h"

namespace
{
/*!
  The line to an emulated board, which does to each answer what the input says: hands it on, spoils it, holds
  it up, or puts another one with a right CRC in its place.
*/
class FuzzedLine : public vpByteTransport
{
public:
  FuzzedLine(std::unique_ptr<vpByteTransport> line, vpEmulatedTransport &world, vpFuzzBytes &input)
      : m_line(std::move(line)), m_world(world), m_input(input)
  {
  }
  double now() const override { return m_line->now(); }
  bool write(const std::uint8_t *bytes, size_t size, double deadline) override
  {
    return m_line->write(bytes, size, deadline);
  }
  size_t read(std::uint8_t *bytes, size_t most, double deadline) override
  {
    size_t size = m_line->read(bytes, most, deadline);
    if (size == 0 || m_input.empty()) {
      return size;
    }
    switch (const std::uint8_t deed = m_input.byte(); deed % 8) {
    case 0: // a byte is another one
      bytes[m_input.byte() % size] ^= m_input.byte();
      break;
    case 1: // it ends early
      size = std::max<size_t>(m_input.byte() % size, 1);
      break;
    case 2: // it comes late
      m_world.advance(now() + 0.001 * m_input.byte());
      break;
    case 3: { // whatever bytes
      const std::vector<std::uint8_t> other = m_input.bytes(std::min<size_t>(most, m_input.byte()));
      std::copy(other.begin(), other.end(), bytes);
      size = std::max<size_t>(other.size(), 1);
      break;
    }
    case 4:
    case 5:
      size = lie(bytes, size, most);
      break;
    default:
      break;
    }
    return size;
  }
  void discard() override { m_line->discard(); }
  void reopen() override { m_line->reopen(); }
  std::string name() const override { return m_line->name(); }

private:
  //! The answer with other parameters, and a right CRC.
  size_t lie(std::uint8_t *bytes, size_t size, size_t most)
  {
    vpDynamixelParser parser;
    parser.push(bytes, size);
    std::optional<vpDynamixelPacket> packet = parser.next();
    if (!packet) {
      return size;
    }
    const std::uint8_t changes = m_input.byte() % 16;
    for (std::uint8_t i = 0; i < changes && !packet->parameters.empty(); ++i) {
      packet->parameters[m_input.byte() % packet->parameters.size()] = m_input.byte();
    }
    if (m_input.byte() % 8 == 0) {
      packet->error = m_input.byte();
    }
    if (m_input.byte() % 8 == 0) {
      packet->parameters.resize(m_input.byte());
    }
    const std::vector<std::uint8_t> other = packet->encoded();
    const size_t taken = std::min(other.size(), most);
    std::copy_n(other.begin(), taken, bytes);
    return taken;
  }

  std::unique_ptr<vpByteTransport> m_line;
  vpEmulatedTransport &m_world;
  vpFuzzBytes &m_input;
};
} // namespace

// A drive of up to a second on such a line; where that fails, a second one on a line opened anew.
VLP_FUZZ_TARGET(bus)
{
  vpFuzzBytes input(data, size);
  vpEmulatedTurtleBot3 emulated;
  vpEmulatedTransport &world = *emulated.line;
  std::unique_ptr<vpRobotTurtleBot3> base;
  const auto drive = [&] {
    double last = base->odometry().timestamp;
    for (int period = 0; period < 50; ++period) {
      const vpBaseVelocity told = base->setVelocity(0.1, 0.5);
      vpFuzzExpect(base->limits().share(told) <= 1 + 1e-9, "a command within limits");
      world.advance(world.now() + 0.02);
      const vpOdometry sample = base->odometry();
      vpFuzzExpect(std::isfinite(sample.timestamp + sample.v + sample.w) && sample.timestamp >= last,
                   "odometry in order, finite");
      vpFuzzExpect(std::abs(sample.v) < 5 && std::abs(sample.w) < 60, "odometry that wheels can do");
      last = sample.timestamp;
    }
  };
  const bool well = vpFuzzReads([&] {
    base =
        std::make_unique<vpRobotTurtleBot3>(std::make_unique<FuzzedLine>(emulated.takeLine(), world, input));
    drive();
  });
  if (base && !well) {
    vpFuzzReads([&] {
      base->reconnect();
      drive();
    });
  }
  // Driver and line are gone: it was told to stop, or its watchdog stops it.
  base.reset();
  emulated.board.advance(emulated.robot.time() + 1.5);
  vpFuzzExpect(emulated.stands(), "a base that stands without its driver");
}
