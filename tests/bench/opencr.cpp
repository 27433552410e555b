/*
 * visp_vlp: visible light positioning for ViSP.
 * SPDX-License-Identifier: GPL-2.0-or-later
 */
// The OpenCR board over bad lines: what was wrong is seen, repeated or told, and the robot stands.
// bench_opencr [TRANSACTIONS]: rows of Markdown tables, 100000 transactions for each share of corrupted bytes

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <visp3/core/vpException.h>

#include "opencr/vpEmulatedTurtleBot3.h"
#include "opencr/vpStandstill.h"

namespace
{
using Table = vpOpenCrTable;

constexpr size_t ofOneLife = 2000; // transactions until the board, its robot and the seed are new ones
constexpr double deadline = 0.2;   // s, of a transaction

double quantile(std::vector<double> &values, double share)
{
  if (values.empty()) {
    return NAN;
  }
  const size_t index =
      std::min(values.size() - 1, static_cast<size_t>(share * static_cast<double>(values.size())));
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(index), values.end());
  return values[index];
}

vpFaultyLine::Faults faultsOf(double corrupted, bool others, std::uint64_t seed)
{
  vpFaultyLine::Faults faults;
  faults.corrupted = corrupted;
  faults.lost = others ? corrupted / 10 : 0;
  faults.delayed = others ? corrupted : 0;
  faults.seed = seed;
  return faults;
}

//! Of the bus alone.
struct BusResult {
  std::uint64_t transactions = 0, spoilt = 0, unseen = 0, seenByHost = 0, seenByBoard = 0, unanswered = 0;
  std::uint64_t repeated = 0, told = 0;
  std::uint64_t wrongReadings = 0; // used, though the board never sent that
  std::uint64_t falseWrites = 0;   // confirmed for certain, though the board did not carry it out
  std::uint64_t stale = 0;         // confirmed by an answer that may be stale
  std::vector<double> times;       // s, of those that succeeded
};

//! Whether the board carried out, since \e first, a request with these parameters, and answered \e answer.
bool carriedOut(const std::vector<vpOpenCrEmulator::Request> &requests, size_t first,
                const std::vector<std::uint8_t> &parameters, const std::vector<std::uint8_t> &answer)
{
  return std::any_of(requests.begin() + static_cast<std::ptrdiff_t>(first), requests.end(),
                     [&](const auto &request) {
                       return request.packet.parameters == parameters && request.answer == answer;
                     });
}

void liveOnBus(double corrupted, bool others, std::uint64_t seed, size_t transactions, BusResult &result)
{
  vpEmulatedTurtleBot3 emulated;
  vpDynamixelBus bus(emulated.takeLine());
  emulated.line->setFaults(faultsOf(corrupted, others, seed));
  std::mt19937_64 random(seed);
  const std::vector<std::uint8_t> tableRequest = {Table::snapshotAddress, 0, Table::snapshotLength, 0};
  for (size_t i = 0; i < transactions; ++i) {
    const size_t before = emulated.board.requests().size();
    const std::uint64_t attempts = bus.statistics().attempts;
    const double begin = bus.now();
    bool confirmed = true, wasDone = false;
    try {
      if (i % 3 == 2) {
        const std::vector<std::uint8_t> got =
            bus.read(Table::id, Table::snapshotAddress, Table::snapshotLength, begin + deadline);
        wasDone = carriedOut(emulated.board.requests(), before, tableRequest, got);
        result.wrongReadings += !carriedOut(emulated.board.requests(), 0, tableRequest, got);
      } else {
        std::vector<std::uint8_t> bytes(i % 3 == 0 ? 1 : Table::commandLength);
        std::generate(bytes.begin(), bytes.end(), [&] { return static_cast<std::uint8_t>(random()); });
        const std::uint16_t address = i % 3 == 0 ? Table::heartbeat.address : Table::commandAddress;
        bus.write(Table::id, address, bytes, begin + deadline);
        bytes.insert(bytes.begin(), {static_cast<std::uint8_t>(address), 0});
        wasDone = carriedOut(emulated.board.requests(), before, bytes, {});
        result.falseWrites += !wasDone && !bus.answerMayBeStale();
      }
      result.stale += bus.answerMayBeStale();
      result.times.push_back(bus.now() - begin);
    } catch (const vpException &) {
      confirmed = false;
    }
    result.repeated += confirmed && bus.statistics().attempts > attempts + 1;
    result.told += !confirmed;
    emulated.line->advance(bus.now() + 0.005);
  }
  result.transactions += transactions;
  result.spoilt += emulated.line->cable().spoilt();
  result.unseen += emulated.line->cable().unseen();
  result.seenByHost += bus.statistics().crcErrors;
  result.unanswered += bus.statistics().timeouts;
  result.seenByBoard += emulated.board.crcErrors();
}

void printBus(size_t transactions)
{
  std::printf("\n| bytes corrupted | also lost, held up | transactions | messages spoilt | of them beyond "
              "the CRC | CRC wrong at host "
              "| at board |"
              " unanswered | repeated | told (ioError) | answered | time median, 99 %%, most (ms) |"
              " wrong readings used | writes confirmed, not done |\n"
              "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto &[corrupted, others] :
       {std::pair<double, bool>{0, false}, {1e-4, false}, {1e-4, true}, {1e-2, false}, {1e-2, true}}) {
    BusResult result;
    for (std::uint64_t seed = 1; result.transactions < transactions; ++seed) {
      liveOnBus(corrupted, others, seed, std::min(ofOneLife, transactions - result.transactions), result);
    }
    const double answered = static_cast<double>(result.times.size());
    std::printf("| %g %% | %s | %lu | %lu | %lu | %lu | %lu | %lu | %lu | %lu | %.3f %% | %.1f, %.1f, %.1f | "
                "%lu | %lu |\n",
                100 * corrupted, others ? "yes" : "no", result.transactions, result.spoilt, result.unseen,
                result.seenByHost, result.seenByBoard, result.unanswered, result.repeated, result.told,
                100 * answered / static_cast<double>(result.transactions), 1e3 * quantile(result.times, 0.5),
                1e3 * quantile(result.times, 0.99), 1e3 * quantile(result.times, 1), result.wrongReadings,
                result.falseWrites);
    std::fflush(stdout);
  }
}

//! Of the robot driven at 50 Hz.
struct DriveResult {
  std::uint64_t transactions = 0, periods = 0, errors = 0, refusals = 0, spoilt = 0;
  std::uint64_t falseCommands = 0;    // setVelocity() returned, and the board held another command
  double driven = 0;                  // s
  std::vector<double> odometryErrors; // m: the way so far against the true one at the sample's time
  std::vector<double> odometryAges;   // s
  std::vector<double> errorTimes;     // s, from the call to its error
  std::vector<double> standstills;    // s, from the call that failed
  std::vector<double> periodTimes;    // s, of setVelocity() and odometry() together
};

void liveOfDriver(double corrupted, bool others, std::uint64_t seed, DriveResult &result)
{
  vpSimulatorTurtleBot3Settings world;
  world.motorLag = 0.03;
  vpEmulatedTurtleBot3 emulated(vpOpenCrEmulator::Settings(), world);
  const auto base = emulated.driver();
  emulated.line->setFaults(faultsOf(corrupted, others, seed));
  const auto trueWay = [&](double time) { return emulated.robot.wMb(time)[0][3]; };
  double way = 0, last = base->odometry().timestamp, start = trueWay(last);
  for (size_t i = 0; base->statistics().transactions < ofOneLife; ++i) {
    if (!base->connected()) {
      try {
        base->reconnect();
      } catch (const vpException &) {
        ++result.refusals;
        continue;
      }
      way = 0;
      last = base->odometry().timestamp;
      start = trueWay(last);
    }
    const double begin = emulated.line->now();
    try {
      const vpBaseVelocity told = base->setVelocity(0.1 + 0.1 * std::sin(0.02 * static_cast<double>(i)), 0);
      result.falseCommands += emulated.board.table().get(Table::commandV) != std::lround(100 * told.v);
      const vpOdometry odometry = base->odometry();
      way += odometry.v * (odometry.timestamp - last);
      last = odometry.timestamp;
      result.odometryErrors.push_back(std::abs(start + way - trueWay(last)));
      result.odometryAges.push_back(emulated.line->now() - last);
      result.periodTimes.push_back(emulated.line->now() - begin);
      emulated.line->advance(begin + 0.02);
    } catch (const vpException &) {
      ++result.errors;
      result.errorTimes.push_back(emulated.line->now() - begin);
      emulated.line->advance(emulated.line->now() + 1);
      result.standstills.push_back(vpStandstillAfter(emulated.robot, begin));
    }
    result.driven += emulated.line->now() - begin;
    ++result.periods;
  }
  result.transactions += base->statistics().transactions;
  result.spoilt += emulated.line->cable().spoilt();
}

void printDrive(size_t transactions)
{
  std::printf("\n| bytes corrupted | also lost, held up | transactions | messages spoilt | periods | their "
              "time median,"
              " 99 %%, most (ms) | connections given up | one in (s) | told after, most (s) | stands after, "
              "most (s) |"
              " commands confirmed, not held | odometry error 99 %%, most (mm) | its age 99 %%, most (ms) |\n"
              "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const auto &[corrupted, others] : {std::pair<double, bool>{0, false},
                                          {1e-4, false},
                                          {1e-4, true},
                                          {1e-3, false},
                                          {1e-3, true},
                                          {1e-2, false},
                                          {1e-2, true}}) {
    DriveResult result;
    for (std::uint64_t seed = 1; result.transactions < transactions; ++seed) {
      liveOfDriver(corrupted, others, seed, result);
    }
    std::printf("| %g %% | %s | %lu | %lu | %lu | %.1f, %.1f, %.1f | %lu | %.3g | %.3f | %.3f | %lu | %.2f, "
                "%.2f | %.1f, %.1f |\n",
                100 * corrupted, others ? "yes" : "no", result.transactions, result.spoilt, result.periods,
                1e3 * quantile(result.periodTimes, 0.5), 1e3 * quantile(result.periodTimes, 0.99),
                1e3 * quantile(result.periodTimes, 1), result.errors,
                result.driven / static_cast<double>(result.errors), quantile(result.errorTimes, 1),
                quantile(result.standstills, 1), result.falseCommands,
                1e3 * quantile(result.odometryErrors, 0.99), 1e3 * quantile(result.odometryErrors, 1),
                1e3 * quantile(result.odometryAges, 0.99), 1e3 * quantile(result.odometryAges, 1));
    std::fflush(stdout);
  }
}
//! What happens to a base that drives, and whether its control loop goes on calling it.
struct Fault {
  const char *name;
  std::function<void(vpEmulatedTurtleBot3 &, std::unique_ptr<vpRobotTurtleBot3> &)> happens;
  bool loopGoesOn;
};

//! s from the fault to the standstill of a base at 0.2 m/s.
double standstillOf(const Fault &fault, std::uint64_t seed)
{
  vpSimulatorTurtleBot3Settings world;
  world.motorLag = 0.03;
  vpEmulatedTurtleBot3 emulated(vpOpenCrEmulator::Settings(), world);
  std::unique_ptr<vpRobotTurtleBot3> base = emulated.driver();
  const auto drive = [&](double until) {
    while (emulated.line->now() < until) {
      const double begin = emulated.line->now();
      base->odometry();
      base->setVelocity(0.2, 0);
      emulated.line->advance(std::min(begin + 0.02, std::max(until, emulated.line->now())));
    }
  };
  std::mt19937_64 random(seed);
  drive(1 + std::uniform_real_distribution<double>(0, 0.02)(random));
  const double time = emulated.line->now();
  try {
    fault.happens(emulated, base);
    if (fault.loopGoesOn) {
      drive(time + 2);
    }
  } catch (const vpException &) {
  }
  emulated.line = nullptr; // perhaps gone with its driver
  emulated.board.advance(time + 3);
  return vpStandstillAfter(emulated.robot, time);
}

void printFaults()
{
  const auto bad = [](double corrupted, double lost) {
    return [=](vpEmulatedTurtleBot3 &emulated, std::unique_ptr<vpRobotTurtleBot3> &) {
      vpFaultyLine::Faults faults;
      faults.corrupted = corrupted;
      faults.lost = lost;
      emulated.line->setFaults(faults);
    };
  };
  const std::vector<Fault> all = {
      {"stop()", [](auto &, auto &base) { base->stop(); }, false},
      {"driver destroyed, as by an exception", [](auto &, auto &base) { base.reset(); }, false},
      {"no more calls: loop hangs, process killed", [](auto &, auto &) {}, false},
      {"cable pulled, noticed", [](auto &emulated, auto &) { emulated.line->pullCable(); }, true},
      {"all bytes lost", bad(0, 1), true},
      {"all bytes corrupted", bad(1, 0), true},
      {"5 % of bytes corrupted", bad(0.05, 0), true},
      {"a command answered with an error",
       [](auto &emulated, auto &base) {
         emulated.board.failNext(vpDynamixelPacket::dataLimit);
         base->setVelocity(0.2, 0);
       },
       true},
      {"board restarted", [](auto &emulated, auto &) { emulated.board.restart(); }, true},
  };
  constexpr int trials = 200;
  std::printf("\n| at 0.2 m/s, motor lag 30 ms, %d trials | stands after median, most (s) |\n|---|---|\n",
              trials);
  for (const Fault &fault : all) {
    std::vector<double> times;
    for (std::uint64_t seed = 1; seed <= trials; ++seed) {
      times.push_back(standstillOf(fault, seed));
    }
    std::printf("| %s | %.3f, %.3f |\n", fault.name, quantile(times, 0.5), quantile(times, 1));
  }
}
} // namespace

int main(int argc, char **argv)
{
  const size_t transactions = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100000;
  printBus(transactions);
  printDrive(transactions);
  printFaults();
  return 0;
}
