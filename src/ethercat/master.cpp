#include "ethercat/master.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "ethercat/coe_dictionary.hpp"
#include "ethercat/datagrams.hpp"
#include "ethercat/soem_port.hpp"
#include "io/clock.hpp"

namespace pmg::ethercat {

namespace {

constexpr int kMostSlaves = 64, kMostGroups = 1;
constexpr int kStartTries = 20;

}  // namespace

struct Master::Soem {
  std::unique_ptr<SoemPort> port;
  std::array<ec_slavet, kMostSlaves + 1> slaves{};
  std::array<ec_groupt, kMostGroups + 1> groups{};
  int slave_count = 0;
  std::array<uint8, EC_MAXEEPBUF> eeprom{};
  std::array<uint32, EC_MAXEEPBITMAP> eeprom_map{};
  ec_eringt errors{};
  ec_idxstackT stack{};
  boolean failed = FALSE;
  int64 dc_time = 0;
  std::array<ec_SMcommtypet, EC_MAX_MAPT> sm_types{};
  std::array<ec_PDOassignt, EC_MAX_MAPT> assigned{};
  std::array<ec_PDOdesct, EC_MAX_MAPT> described{};
  ec_eepromSMt eeprom_sm{};
  ec_eepromFMMUt eeprom_fmmu{};
  ecx_contextt context{};

  explicit Soem(Wire& wire) : port(make_port(wire)) {
    context.port = &port->soem;
    context.slavelist = slaves.data();
    context.slavecount = &slave_count;
    context.maxslave = static_cast<int>(slaves.size());
    context.grouplist = groups.data();
    context.maxgroup = static_cast<int>(groups.size());
    context.esibuf = eeprom.data();
    context.esimap = eeprom_map.data();
    context.elist = &errors;
    context.idxstack = &stack;
    context.ecaterror = &failed;
    context.DCtime = &dc_time;
    context.SMcommtype = sm_types.data();
    context.PDOassign = assigned.data();
    context.PDOdesc = described.data();
    context.eepSM = &eeprom_sm;
    context.eepFMMU = &eeprom_fmmu;
  }
  /// The first slave that isn't in this state, in words.
  std::string who_is_not(uint16 state) {
    ecx_readstate(&context);
    for (int i = 1; i <= slave_count; ++i) {
      const ec_slavet& slave = slaves[static_cast<std::size_t>(i)];
      if (slave.state == state) continue;
      return fmt::format("slave {} ({}) stays in state 0x{:02X}, AL status code 0x{:04X}", i, slave.name, slave.state,
                         slave.ALstatuscode);
    }
    return "a slave changes its state late";
  }
};

Master::Master(Wire& wire, const std::string& name, const std::vector<SlaveSetup>& slaves, const StartTiming& timing)
    : wire_(wire), name_(name), soem_(std::make_unique<Soem>(wire)), answer_(kMostFrame) {
  soem_timeouts.ret = timing.answer_us;
  soem_timeouts.safe = 5 * timing.answer_us;
  soem_timeouts.eeprom = timing.answer_us;
  soem_timeouts.tx_mailbox = timing.answer_us;
  soem_timeouts.rx_mailbox = timing.mailbox_us;
  soem_timeouts.state = timing.state_us;
  find(slaves);
  prepare(slaves);
  map(slaves);
  if (reference_ != 0) set_clocks();
  start();
}

Master::~Master() {
  soem_->slaves[0].state = EC_STATE_INIT;
  ecx_writestate(&soem_->context, 0);
}

void Master::fail(const std::string& what) const { throw std::runtime_error(name_ + ": " + what); }

void Master::find(const std::vector<SlaveSetup>& slaves) {
  // Slaves keep their station addresses from an earlier start. Where they were joined in another order since, two would
  // answer to one address while SOEM gives them new ones.
  std::uint16_t no_address = 0;
  ecx_BWR(soem_->context.port, 0, ECT_REG_STADR, sizeof no_address, &no_address, EC_TIMEOUTRET3);
  if (ecx_config_init(&soem_->context, FALSE) <= 0)
    fail("no EtherCAT slave answers; expected " + std::to_string(slaves.size()));
  slaves_ = soem_->slave_count;
  if (static_cast<std::size_t>(slaves_) != slaves.size())
    fail(fmt::format("{} slaves answer; expected {} as in robot.yaml", slaves_, slaves.size()));
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    const ec_slavet& found = soem_->slaves[i + 1];
    const auto compare = [&](const char* what, std::uint32_t is, std::uint32_t expected) {
      if (expected == 0 || is == expected) return;
      fail(fmt::format("slave {} ({}) has {} 0x{:X}; expected 0x{:X} as in robot.yaml", i + 1, found.name, what, is,
                       expected));
    };
    compare("vendor", found.eep_man, slaves[i].vendor_id);
    compare("product code", found.eep_id, slaves[i].product_code);
    compare("alias", found.aliasadr, static_cast<std::uint32_t>(slaves[i].alias));
    if (found.hasdc != 0 && reference_ == 0) reference_ = found.configadr;
  }
}

void Master::prepare(const std::vector<SlaveSetup>& slaves) {
  ecx_contextt* context = &soem_->context;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    const auto position = static_cast<std::uint16_t>(i + 1);
    ec_slavet& found = soem_->slaves[position];
    if (ecx_statecheck(context, position, EC_STATE_PRE_OP, EC_TIMEOUTSTATE) != EC_STATE_PRE_OP)
      fail(soem_->who_is_not(EC_STATE_PRE_OP) + "; expected pre-operational");
    if (slaves[i].output_bytes > 0) set_watchdog(i);
    if (!slaves[i].prepare) continue;
    if ((found.mbx_proto & ECT_MBXPROT_COE) == 0)
      fail(fmt::format("slave {} ({}) has no CANopen over EtherCAT; expected {}", i + 1, found.name, slaves[i].who));
    try {
      CoeDictionary dictionary(*context, position);
      slaves[i].prepare(dictionary);
    } catch (const std::runtime_error& error) {
      fail(fmt::format("slave {}, {} {}", i + 1, slaves[i].who, error.what()));
    }
    // As was just mapped; SOEM would ask for it object by object.
    found.configindex = 1;
    found.Obits = static_cast<uint16>(8 * slaves[i].output_bytes);
    found.Ibits = static_cast<uint16>(8 * slaves[i].input_bytes);
    found.SM[2].SMlength = static_cast<uint16>(slaves[i].output_bytes);
    found.SM[3].SMlength = static_cast<uint16>(slaves[i].input_bytes);
  }
}

// The time is that of ESCs, 25 MHz: (divider + 2) 40 ns a count.
void Master::set_watchdog(std::size_t slave) {
  constexpr std::uint16_t kDivider = 0x400, kSyncManagers = 0x420, kCount_100us = 2498;
  constexpr std::uint16_t kCounts = kWatchdog_us / 100;
  ec_slavet& found = soem_->slaves[slave + 1];
  ecx_portt* port = soem_->context.port;
  ecx_FPWRw(port, found.configadr, kDivider, kCount_100us, EC_TIMEOUTRET3);
  ecx_FPWRw(port, found.configadr, kSyncManagers, kCounts, EC_TIMEOUTRET3);
  const std::uint16_t kept = ecx_FPRDw(port, found.configadr, kSyncManagers, EC_TIMEOUTRET3);
  if (kept != kCounts)
    fail(fmt::format("slave {} ({}) keeps a watchdog of {} counts; expected one that can be set to {} ms", slave + 1,
                     found.name, kept, kWatchdog_us / 1000));
  // The EEPROM may have left the watchdog of the outputs off.
  constexpr std::uint32_t kWatched = 0x40;
  found.SM[found.mbx_l > 0 ? 2 : 0].SMflags |= kWatched;
}

void Master::map(const std::vector<SlaveSetup>& slaves) {
  std::size_t bytes = 0;
  for (const SlaveSetup& slave : slaves) bytes += slave.output_bytes + slave.input_bytes;
  // SOEM maps what the slaves say they have; room for a slave that claims more than robot.yaml.
  constexpr std::size_t kMostClaimed = 8192;
  image_.assign(std::max<std::size_t>(bytes, kMostClaimed) + slaves.size() * 2 * 2048, 0);
  ecx_config_map_group(&soem_->context, image_.data(), 0);
  const ec_groupt& group = soem_->groups[0];
  output_bytes_ = group.Obytes;
  input_bytes_ = group.Ibytes;
  logical_start_ = group.logstartaddr;
  for (std::size_t i = 0; i < slaves.size(); ++i) {
    ec_slavet& found = soem_->slaves[i + 1];
    if (found.Obytes != slaves[i].output_bytes || found.Ibytes != slaves[i].input_bytes) {
      fail(fmt::format("slave {} ({}) takes {} bytes and gives {} in a cycle; expected {} and {} as in robot.yaml",
                       i + 1, found.name, found.Obytes, found.Ibytes, slaves[i].output_bytes, slaves[i].input_bytes));
    }
    outputs_.emplace_back(found.outputs, found.Obytes);
    inputs_.emplace_back(found.inputs, found.Ibytes);
    writers_ += found.Obytes > 0 ? 1 : 0;
    readers_ += found.Ibytes > 0 ? 1 : 0;
  }
  // Each half of a cycle is one frame.
  constexpr std::size_t kRoom = kMostFrame - FrameWriter::kHeader - 4 * FrameWriter::kOverhead - 2 - 8 - 4;
  if (output_bytes_ > kRoom || input_bytes_ > kRoom)
    fail(fmt::format("{} bytes of outputs and {} of inputs in a cycle; expected {} at most", output_bytes_,
                     input_bytes_, kRoom));
}

// Propagation delays and offsets by SOEM; then the clocks follow the reference until they agree.
void Master::set_clocks() {
  constexpr int kTries = 2'000;
  constexpr std::int64_t kTogether_ns = 1'000;
  ecx_contextt* context = &soem_->context;
  ecx_configdc(context);
  for (int k = 0; k < kTries; ++k) {
    read();
    if (k > 0 && state_.answered && state_.apart_ns <= kTogether_ns) break;
  }
  if (state_.apart_ns > kTogether_ns)
    fail(fmt::format("the slaves' clocks stay {:.1f} us apart; expected less than {:.0f} us",
                     1e-3 * static_cast<double>(state_.apart_ns), 1e-3 * static_cast<double>(kTogether_ns)));
  for (std::uint16_t slave = 1; slave <= static_cast<std::uint16_t>(slaves_); ++slave) {
    if (soem_->slaves[slave].hasdc != 0) ecx_dcsync0(context, slave, TRUE, kPeriod_ns, 0);
  }
}

void Master::start() {
  ecx_contextt* context = &soem_->context;
  if (ecx_statecheck(context, 0, EC_STATE_SAFE_OP, EC_TIMEOUTSTATE) != EC_STATE_SAFE_OP)
    fail(soem_->who_is_not(EC_STATE_SAFE_OP) + "; expected safe-operational");
  read();
  write(false);
  soem_->slaves[0].state = EC_STATE_OPERATIONAL;
  ecx_writestate(context, 0);
  for (int k = 0; k < kStartTries; ++k) {
    read();
    write(false);
    if (ecx_statecheck(context, 0, EC_STATE_OPERATIONAL, EC_TIMEOUTSTATE / 100) == EC_STATE_OPERATIONAL) return;
  }
  fail(soem_->who_is_not(EC_STATE_OPERATIONAL) + "; expected operational");
}

std::span<std::uint8_t> Master::outputs(std::size_t slave) noexcept { return outputs_[slave]; }
std::span<const std::uint8_t> Master::inputs(std::size_t slave) const noexcept { return inputs_[slave]; }

bool Master::transfer(std::span<const std::uint8_t> frame, std::int64_t within_ns) noexcept {
  answer_bytes_ = 0;
  if (!wire_.send(frame)) return false;
  const io::WallClock clock;
  const std::int64_t deadline_ns = cycle_begin_ns_ + within_ns;
  for (;;) {
    const std::int64_t left_ns = std::max<std::int64_t>(deadline_ns - clock.now_ns(), 0);
    const std::size_t bytes = wire_.receive(answer_, left_ns);  // a thread that was held up looks once more
    if (bytes == 0 && left_ns == 0) return false;
    if (!FrameReader(std::span(answer_).first(bytes), frame).valid()) continue;  // none yet, or one that was given up
    answer_bytes_ = bytes;
    return true;
  }
}

bool Master::read() noexcept {
  constexpr std::array<std::uint8_t, 8> kNothing{};
  FrameWriter frame(++index_);
  const std::span<std::uint8_t> inputs = std::span(image_).subspan(output_bytes_, input_bytes_);
  frame.add(Command::kLogicalRead, logical_start_ + static_cast<std::uint32_t>(output_bytes_), inputs);
  frame.add(Command::kBroadcastRead, std::uint32_t{kAlStatus} << 16U, std::span(kNothing).first(2));
  if (reference_ != 0) {
    frame.add(Command::kReadOneWriteOthers, std::uint32_t{kSystemTime} << 16U | reference_, kNothing);
    frame.add(Command::kBroadcastRead, std::uint32_t{kTimeDifference} << 16U, std::span(kNothing).first(4));
  }
  state_ = {};
  cycle_begin_ns_ = io::WallClock().now_ns();
  if (!transfer(frame.bytes(), kInputsWithin_ns)) return false;
  FrameReader reader{std::span<const std::uint8_t>(answer_).first(answer_bytes_), frame.bytes()};
  Datagram read, status, clock, difference;
  if (!reader.next(read) || !reader.next(status)) return false;
  if (reference_ != 0 && (!reader.next(clock) || !reader.next(difference))) return false;
  state_.answered = true;
  for (std::size_t i = 0; i < clock.data.size(); ++i)
    state_.clock_ns |= static_cast<std::int64_t>(clock.data[i]) << 8 * static_cast<int>(i);
  // Magnitudes, whose sign is the highest bit, ORed: less than twice the largest.
  for (std::size_t i = 0; i < difference.data.size(); ++i)
    state_.apart_ns |= static_cast<std::int64_t>(difference.data[i] & (i == 3 ? 0x7FU : 0xFFU))
                       << 8 * static_cast<int>(i);
  state_.readers = read.working_counter;
  state_.slaves = status.working_counter;
  state_.al_status = status.data[0];
  if (state_.readers != readers_) return false;
  std::ranges::copy(read.data, inputs.begin());
  return true;
}

void Master::write(bool recover) noexcept {
  constexpr std::array<std::uint8_t, 2> kBackToOperational = {kOperational | kAcknowledge, 0};
  FrameWriter frame(++index_);
  frame.add(Command::kLogicalWrite, logical_start_, std::span(image_).first(output_bytes_));
  if (recover) frame.add(Command::kBroadcastWrite, std::uint32_t{kAlControl} << 16U, kBackToOperational);
  Datagram written;
  if (!transfer(frame.bytes(), kOutputsWithin_ns) ||
      !FrameReader{std::span<const std::uint8_t>(answer_).first(answer_bytes_), frame.bytes()}.next(written)) {
    state_.answered = false;
  } else {
    state_.writers = written.working_counter;
  }
  state_.good = state_.answered && state_.readers == readers_ && state_.writers == writers_ &&
                state_.slaves == slaves_ && state_.al_status == kOperational && state_.apart_ns <= kMostApart_ns;
}

}  // namespace pmg::ethercat
