// The slaves of one cable: brought up by SOEM, exchanged with in each bus cycle by frames of our own.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "drive_protocols/cia402_objects.hpp"
#include "ethercat/wire.hpp"

namespace pmg::ethercat {

/// What is expected at one position of the cable, the first being 1.
struct SlaveSetup {
  std::uint32_t vendor_id = 0, product_code = 0;  ///< 0: any
  int alias = 0;  ///< configured station alias, which tells slaves of one kind apart; 0: any
  std::size_t output_bytes = 0, input_bytes = 0;
  std::string who;  ///< for messages: "left_hip (legs, node 1)"; empty: the slave's own name
  /// Checks and sets up its objects in pre-operational, before its process data are mapped; throws std::runtime_error.
  /// Empty: nothing to do.
  std::function<void(drives::ObjectDictionary&)> prepare;
};

/// What one cycle said of the cable.
struct CableState {
  bool answered = false;         ///< both frames came back
  int readers = 0, writers = 0;  ///< slaves that gave inputs, that took outputs: the working counters
  int slaves = 0;                ///< that answered at all
  std::uint8_t al_status = 0;    ///< of all slaves, ORed
  bool good = false;             ///< every slave gives, takes and is operational, and there is none too many
  std::int64_t clock_ns = 0;     ///< the slaves' time when this cycle's first frame passed the reference clock
  std::int64_t apart_ns =
      0;  ///< how far slaves' clocks are from the reference clock: a bound, less than twice the most
};

/// How long an answer is awaited before the bus cycle begins [us].
struct StartTiming {
  int answer_us = 20'000;  ///< to a frame: slaves in hardware need some 0.1 ms, emulated ones share a computer
  int mailbox_us = 700'000;
  int state_us = 500'000;  ///< for a new state
};

class Master {
 public:
  /// How long after a bus cycle's begin its first and its second frame are awaited. Long, because a late answer is
  /// worth more than a cycle without one; the cycle of 2 ms ends in time also when neither comes.
  static constexpr std::int64_t kInputsWithin_ns = 1'300'000, kOutputsWithin_ns = 1'800'000;
  /// Outputs that don't come for so long take a slave out of operational: 10 bus cycles, as for drives on CAN.
  static constexpr int kWatchdog_us = 20'000;
  /// Distance of the slaves' clocks that is no trouble. Their data are to be of one moment within much less than a
  /// cycle of 2 ms; controllers keep 0.1 us.
  static constexpr std::int64_t kMostApart_ns = 20'000;
  /// When slaves with a clock put outputs into force, after a multiple of 2 ms of their time. A cycle's first frame is
  /// to pass at kPhase_ns: then outputs are there 1.5 ms before.
  static constexpr std::int64_t kPeriod_ns = 2'000'000, kPhase_ns = 500'000;

  /// Finds the slaves, compares them with `slaves`, and brings them to OP with outputs of zero. name: of the interface,
  /// for messages. Throws std::runtime_error, one line.
  Master(Wire& wire, const std::string& name, const std::vector<SlaveSetup>& slaves, const StartTiming& timing = {});
  ~Master();
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  /// The process data of the slave at this index (position - 1).
  std::span<std::uint8_t> outputs(std::size_t slave) noexcept;
  std::span<const std::uint8_t> inputs(std::size_t slave) const noexcept;
  bool has_clock() const noexcept { return reference_ != 0; }  ///< some slave has a distributed clock

  /// The halves of a cycle. No heap, no lock. read(): inputs of all slaves, their states and clocks. False: the inputs
  /// aren't those of this cycle.
  bool read() noexcept;
  /// Outputs to all slaves. recover: a slave that its watchdog took out of OP is told to go back there.
  void write(bool recover) noexcept;
  const CableState& state() const noexcept { return state_; }

 private:
  struct Soem;
  void find(const std::vector<SlaveSetup>& slaves);
  void prepare(const std::vector<SlaveSetup>& slaves);
  void map(const std::vector<SlaveSetup>& slaves);
  void set_watchdog(std::size_t slave);
  void set_clocks();
  void start();
  [[noreturn]] void fail(const std::string& what) const;
  bool transfer(std::span<const std::uint8_t> frame, std::int64_t within_ns) noexcept;

  Wire& wire_;
  std::string name_;
  std::unique_ptr<Soem> soem_;
  std::vector<std::uint8_t> image_;  // outputs, then inputs
  std::size_t output_bytes_ = 0, input_bytes_ = 0;
  std::vector<std::span<std::uint8_t>> outputs_, inputs_;
  int slaves_ = 0, readers_ = 0, writers_ = 0;
  std::uint16_t reference_ = 0;  // station address of the slave whose clock the others follow; 0: none
  std::uint32_t logical_start_ = 0;
  std::uint8_t index_ = 0;
  std::int64_t cycle_begin_ns_ = 0;
  std::vector<std::uint8_t> answer_;
  std::size_t answer_bytes_ = 0;
  CableState state_;
};

}  // namespace pmg::ethercat
