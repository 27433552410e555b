/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
#include "vpLampBoard.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include <visp3/core/vpException.h>
#include <visp3/vlp_core/vpNumberText.h>

BEGIN_VISP_NAMESPACE

namespace
{
const std::string sends = "lamp "; // how an answer begins that says what it sends

//! A plain decimal of up to six digits after the point, as the firmware reads it.
std::string decimal(double value)
{
  char text[64];
  std::snprintf(text, sizeof text, "%.6f", value);
  std::string shortened = text;
  shortened.erase(shortened.find_last_not_of('0') + 1);
  return shortened.back() == '.' ? shortened + "0" : shortened;
}

//! Whether a rate or share that is sent is the one wanted, to half a cycle of the clock and the digits it is
//! told with.
bool isCycleOf(double sent, double wanted, double perCycle)
{
  static const double told = 1e-3; // Hz, half of which the answer may be rounded by
  return std::abs(sent - wanted) <= perCycle + told;
}
} // namespace

vpLampBoard::vpLampBoard(std::unique_ptr<vpByteTransport> line) : m_line(std::move(line))
{
  static const int attempts = 8; // over the two seconds for which an Arduino's bootloader listens, and more
  static const double pause = 0.5;
  for (int k = 0; k < attempts; ++k) {
    ask("", 0); // ends what somebody else may have begun
    if (ask("show", pause).compare(0, sends.size(), sends) == 0) {
      return;
    }
  }
  fail("no answer to 'show'");
}

std::string vpLampBoard::show()
{
  return answered("show", 1);
}

std::string vpLampBoard::lineOf(const vpLamp &lamp)
{
  const vpModulation &modulation = lamp.modulation;
  std::string line = "set";
  switch (modulation.kind) {
  case vpModulation::Kind::unmodulated:
    line += " unmodulated=true";
    break;
  case vpModulation::Kind::word:
    line += " bits=" + modulation.bits + " chip_rate_hz=" + decimal(modulation.chipRate) +
            " code=" + (modulation.code == vpModulation::Code::manchester ? "manchester" : "ook");
    break;
  case vpModulation::Kind::pwm:
  case vpModulation::Kind::twoPulse:
    if (!modulation.duty) {
      throw vpException(vpException::badValue,
                        "lamp " + vpShown(lamp.id) +
                            ": duty: nothing, expected how long to shine of each period");
    }
    line += " frequency_hz=" + decimal(modulation.frequency) + " duty=" + decimal(*modulation.duty);
    if (modulation.kind == vpModulation::Kind::twoPulse) {
      line += " phase_difference=" + decimal(modulation.phaseDifference);
    }
  }
  return line + " id=" + lamp.id;
}

double vpLampBoard::valueOf(const std::string &sent, const std::string &name)
{
  const std::string field = " " + name + "=";
  const size_t at = (" " + sent).find(field);
  double value = std::nan("");
  if (at != std::string::npos) {
    const size_t begin = at + field.size() - 1;
    vpParseNumber(sent.substr(begin, sent.find(' ', begin) - begin), value);
  }
  return value;
}

std::string vpLampBoard::set(const vpLamp &lamp)
{
  static const double writing = 3; // s, of all bytes of its EEPROM
  const std::string sent = answered(lineOf(lamp), writing), again = show();
  if (again != sent) {
    fail("sends '" + vpShown(again) + "' after it answered '" + vpShown(sent) + "'");
  }
  const vpModulation &modulation = lamp.modulation;
  const bool word = modulation.kind == vpModulation::Kind::word;
  if (modulation.kind != vpModulation::Kind::unmodulated) {
    const double wanted = word ? modulation.chipRate : modulation.frequency,
                 rate = valueOf(sent, word ? "chip_rate_hz" : "frequency_hz");
    if (!isCycleOf(rate, wanted, wanted * wanted / valueOf(sent, "clock_hz"))) {
      fail("sends '" + vpShown(sent) + "', expected " + vpNumberText(wanted) + " Hz");
    }
  }
  return sent;
}

//! \return What it sends. \throw vpException (ioError) where it does not say so.
std::string vpLampBoard::answered(const std::string &line, double seconds)
{
  const std::string answer = ask(line, seconds);
  if (answer.compare(0, sends.size(), sends) != 0) {
    fail(answer.empty() ? "no answer to '" + line + "'"
                        : "to '" + line + "' it says '" + vpShown(answer) + "'");
  }
  return answer.substr(sends.size());
}

//! \return Its answer without line end; empty: none within \e seconds.
std::string vpLampBoard::ask(const std::string &line, double seconds)
{
  m_line->discard();
  const std::string said = line + "\n";
  static const double patience = 1; // s, until the port takes a line
  if (!m_line->write(reinterpret_cast<const std::uint8_t *>(said.data()), said.size(),
                     m_line->now() + patience)) {
    fail("the port takes no bytes");
  }
  static const size_t longest = 1000; // bytes: no firmware of ours says more
  const double deadline = m_line->now() + seconds;
  std::string answer;
  std::uint8_t byte = 0;
  while (answer.size() < longest && m_line->read(&byte, 1, deadline) == 1) {
    if (byte == '\n') {
      return answer.substr(0, answer.find('\r'));
    }
    answer += static_cast<char>(byte);
  }
  return "";
}

void vpLampBoard::fail(const std::string &what) const
{
  throw vpException(vpException::ioError,
                    vpShown(m_line->name()) + ": " + what +
                        ", expected a controller with the firmware of apps/lamp-firmware");
}

END_VISP_NAMESPACE
