// An EtherCAT slave's controller without sockets: datagrams, registers, EEPROM, states, sync managers, their watchdog,
// FMMUs, mailbox, distributed clock. It follows ETG.1000.4 and ETG.1000.6, not the master's code. What the slave does
// comes from a derived class.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ethercat/slave_form.hpp"

namespace pmg::test {

class EmulatedSlave {
 public:
  static constexpr std::uint16_t kInit = 1, kPreOperational = 2, kSafeOperational = 4, kOperational = 8, kError = 0x10;

  explicit EmulatedSlave(SlaveForm form) : form_(std::move(form)), eeprom_(form_.eeprom()) { power_up(); }
  virtual ~EmulatedSlave() = default;

  /// As after power came.
  virtual void power_up() {
    memory_.assign(0x3000, 0);
    memory_[0] = 0x11;
    memory_[4] = memory_[5] = 4;  // FMMUs, sync managers
    memory_[6] = 8;
    memory_[7] = 0x0F;
    set16(0x08, form_.clock ? 0x0C : 0);  // features: clock, of 64 bits
    set16(0x110, 0x0021 | 0x0200);        // link on port 0, communication there
    set16(0x130, kInit);
    set16(0x12, eeprom_[4]);
    set16(0x400, 2498);  // watchdog divider: 100 us
    set16(0x420, 1000);  // sync managers' watchdog: 100 ms
    silent_ticks_ = 0;
    outputs_left_ = 0;
    clock_offset_ns_ = 0;
    mail_.clear();
  }

  /// The effect of one datagram: data and working counter change. `data` is the datagram's.
  void serve(std::uint8_t command, std::uint8_t* address, std::span<std::uint8_t> data, std::uint16_t& counter) {
    if (dead) return;
    const auto low = static_cast<std::uint16_t>(address[0] | address[1] << 8),
               offset = static_cast<std::uint16_t>(address[2] | address[3] << 8);
    const std::uint32_t logical = static_cast<std::uint32_t>(low) | static_cast<std::uint32_t>(offset) << 16U;
    const bool mine = low == 0, fixed = low == get16(0x10) && low != 0;
    switch (command) {
      case 1:
      case 2:
      case 3:
      case 7:
      case 8:
      case 9:  // by position, or everybody
        if (command > 6 || mine) access(command % 3, command > 6, offset, data, counter);
        set_low(address, static_cast<std::uint16_t>(low + 1));
        break;
      case 4:
      case 5:
      case 6:
        if (fixed) access(command % 3, false, offset, data, counter);
        break;
      case 10:
        logical_access(logical, data, true, false, counter);
        break;
      case 11:
        logical_access(logical, data, false, true, counter);
        break;
      case 12:
        logical_access(logical, data, true, true, counter);
        break;
      case 13:
      case 14:  // the addressed one reads, all others write
        if (command == 13 ? mine : fixed) {
          access(1, false, offset, data, counter);
        } else if (offset == kSystemTime && form_.clock) {
          follow_clock(data);
          counter = static_cast<std::uint16_t>(counter + 1);
        } else {
          access(2, false, offset, data, counter);
        }
        if (command == 13) set_low(address, static_cast<std::uint16_t>(low + 1));
        break;
      default:
        break;
    }
  }

  /// 2 ms pass.
  virtual void tick() {
    if (state() != kOperational || mapped_bytes().first == 0) return;  // it watches sync managers of outputs alone
    if ((memory_[output_manager() + 4] & 0x40U) == 0) return;          // where the master has switched the watchdog on
    const int timeout_us = watchdog_us();
    if (timeout_us == 0 || ++silent_ticks_ * 2000 <= timeout_us) return;
    leave(kSafeOperational, 0x001B);  // sync manager watchdog
  }
  void join(std::uint16_t status) { set16(0x130, status); }  ///< somebody else has brought it there
  void leave(std::uint16_t state, std::uint16_t code) {
    set16(0x130, state | kError);
    set16(0x134, code);
    stopped();
  }
  std::uint16_t state() const { return get16(0x130) & 0x0FU; }
  std::uint16_t al_status() const { return get16(0x130); }
  int watchdog_us() const { return get16(0x420) * (get16(0x400) + 2) / 25; }
  void divide_watchdog(int divider) { set16(0x400, divider); }         ///< as another master left it
  bool has_sync() const { return (memory_[0x981] & 0x03U) == 0x03U; }  ///< SYNC0 is generated
  std::uint16_t eeprom_word(std::size_t at) const { return at < eeprom_.size() ? eeprom_[at] : std::uint16_t{0xFFFF}; }
  void set_alias(std::uint16_t alias) {
    eeprom_[4] = alias;
    set16(0x12, alias);
  }
  std::size_t eeprom_words() const { return eeprom_.size(); }
  void lie(std::size_t word, std::uint16_t value) { eeprom_.at(word) = value; }

  /// The slave's clock, as it runs by itself [ns]. Its system time is this plus what the master has set.
  std::function<std::int64_t()> own_clock = [] { return std::int64_t{0}; };
  std::int64_t system_time_ns() const { return own_clock() + clock_offset_ns_; }

  // Faults on demand.
  bool dead = false;             ///< no power: frames pass it unchanged
  int refused_state = 0;         ///< never reached
  int wanted_outputs = 0;        ///< goes to operational after so many outputs
  bool takes_nothing = false;    ///< its outputs' working counter stays
  bool gives_nothing = false;    ///< likewise its inputs
  bool clock_runs_free = false;  ///< it doesn't follow the reference clock
  bool keeps_watchdog = false;   ///< its time can't be set
  /// Of a mailbox: type and service. They come before each answer.
  std::vector<std::pair<std::uint8_t, std::vector<std::uint8_t>>> other_mail;

 protected:
  /// New outputs came, in operational.
  virtual void take(std::span<const std::uint8_t> outputs) = 0;
  /// The inputs are read; `outputs` are the last that came.
  virtual void give(std::span<std::uint8_t> inputs, std::span<const std::uint8_t> outputs) = 0;
  /// A CoE service's bytes => those of its answer; empty: none.
  virtual std::vector<std::uint8_t> answer_mail(std::span<const std::uint8_t>) { return {}; }
  /// What the objects map, in bytes: outputs, inputs.
  virtual std::pair<int, int> mapped_bytes() const { return {form_.output_bytes, form_.input_bytes}; }
  virtual void stopped() {}  ///< left operational
  const SlaveForm& form() const { return form_; }

 private:
  static constexpr std::uint16_t kMailOut = SlaveForm::kMailOut, kMailIn = SlaveForm::kMailIn,
                                 kMailBytes = SlaveForm::kMailBytes, kOutputs = SlaveForm::kOutputs,
                                 kInputs = SlaveForm::kInputs;
  static constexpr std::uint16_t kSystemTime = 0x910, kTimeDifference = 0x92C;
  static constexpr std::uint16_t kMailFull = 0x08;

  std::size_t output_manager() const { return form_.mailbox ? 0x810 : 0x800; }
  std::uint16_t get16(std::size_t at) const { return static_cast<std::uint16_t>(memory_[at] | memory_[at + 1] << 8); }
  std::uint32_t get32(std::size_t at) const { return get16(at) | static_cast<std::uint32_t>(get16(at + 2)) << 16U; }
  void set16(std::size_t at, int value) {
    memory_[at] = static_cast<std::uint8_t>(value & 0xFF);
    memory_[at + 1] = static_cast<std::uint8_t>(value >> 8 & 0xFF);
  }
  void set64(std::size_t at, std::int64_t value) {
    for (std::size_t i = 0; i < 8; ++i) memory_[at + i] = static_cast<std::uint8_t>(value >> 8 * static_cast<int>(i));
  }
  static std::int64_t read64(std::span<const std::uint8_t> bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < std::min<std::size_t>(8, bytes.size()); ++i)
      value |= static_cast<std::uint64_t>(bytes[i]) << 8U * i;
    return static_cast<std::int64_t>(value);
  }
  static void set_low(std::uint8_t* address, std::uint16_t value) {
    address[0] = static_cast<std::uint8_t>(value);
    address[1] = static_cast<std::uint8_t>(value >> 8U);
  }

  /// kind: 1 read, 2 write, 0 both. A broadcast's answers are ORed.
  void access(int kind, bool everybody, std::size_t at, std::span<std::uint8_t> data, std::uint16_t& counter) {
    if (at + data.size() > memory_.size()) return;
    if (form_.mailbox && kind == 2 && at == kMailOut) return take_mail(data, counter);
    if (form_.mailbox && kind == 1 && at == kMailIn) return give_mail(data, counter);
    if (form_.clock) set64(kSystemTime, system_time_ns());
    std::array<std::uint8_t, 1514> before{};
    std::ranges::copy(data, before.begin());
    const std::span written = std::span(before).first(data.size());
    if (kind != 2) {
      for (std::size_t i = 0; i < data.size(); ++i)
        data[i] = everybody ? static_cast<std::uint8_t>(data[i] | memory_[at + i]) : memory_[at + i];
      counter = static_cast<std::uint16_t>(counter + 1);
    }
    if (kind == 1) return;
    counter = static_cast<std::uint16_t>(counter + (kind == 0 ? 2 : 1));
    const std::uint16_t status = get16(0x130);
    for (std::size_t i = 0; i < written.size(); ++i) {
      if (keeps_watchdog && (at + i == 0x420 || at + i == 0x421)) continue;
      if (at + i >= 0x10 && at + i != 0x130 && at + i != 0x131 &&
          (at + i < 0x805 || (at + i) % 8 != 5 || at + i > 0x81F))
        memory_[at + i] = written[i];
    }
    if (at <= 0x120 && at + written.size() > 0x120) change_state(status);
    if (at <= 0x502 && at + written.size() > 0x502) serve_eeprom();
    if (form_.clock && at == 0x900) {  // latches the time of arrival
      set64(0x900, own_clock() & 0xFFFFFFFF);
      set64(0x918, own_clock());
    }
    if (form_.clock && at == 0x920) clock_offset_ns_ = read64(std::span(memory_).subspan(0x920, 8));
  }

  /// The reference clock's time came by: the difference is shown, and most of it goes.
  void follow_clock(std::span<const std::uint8_t> data) {
    const std::int64_t difference = data.size() >= 8
                                        ? system_time_ns() - read64(data)
                                        : static_cast<std::int32_t>(static_cast<std::uint32_t>(system_time_ns()) -
                                                                    static_cast<std::uint32_t>(read64(data)));
    const auto magnitude = static_cast<std::uint32_t>(std::min<std::int64_t>(std::abs(difference), 0x7FFFFFFF));
    const std::uint32_t shown = magnitude | (difference < 0 ? 0x80000000U : 0U);
    set16(kTimeDifference, static_cast<int>(shown & 0xFFFFU));
    set16(kTimeDifference + 2, static_cast<int>(shown >> 16U));
    if (!clock_runs_free) clock_offset_ns_ -= difference / 2;
  }

  void take_mail(std::span<const std::uint8_t> data, std::uint16_t& counter) {
    const std::uint16_t at = state();
    if (at < kPreOperational || data.size() != get16(0x802)) return;
    counter = static_cast<std::uint16_t>(counter + 1);
    const std::size_t length = static_cast<std::size_t>(data[0] | data[1] << 8);
    if ((data[5] & 0x0FU) != 3 || length < 2 || length + 6 > data.size()) return;  // CoE alone
    const std::vector<std::uint8_t> answer = answer_mail(data.subspan(6, length));
    if (answer.empty()) return;
    for (const auto& [type, service] : other_mail) mail_.emplace_back(type, service);
    mail_.emplace_back(data[5], answer);
    next_mail();
  }
  void next_mail() {
    if (mail_.empty() || (memory_[0x80D] & kMailFull) != 0) return;
    const auto& [type, service] = mail_.front();
    std::fill_n(memory_.begin() + kMailIn, kMailBytes, std::uint8_t{0});
    set16(kMailIn, static_cast<int>(service.size()));
    memory_[kMailIn + 5] = type;
    std::ranges::copy(service, memory_.begin() + kMailIn + 6);
    memory_[0x80D] |= kMailFull;
    mail_.pop_front();
  }
  void give_mail(std::span<std::uint8_t> data, std::uint16_t& counter) {
    if ((memory_[0x80D] & kMailFull) == 0 || data.size() != get16(0x80A)) return;
    counter = static_cast<std::uint16_t>(counter + 1);
    std::copy_n(memory_.begin() + kMailIn, data.size(), data.begin());
    memory_[0x80D] &= static_cast<std::uint8_t>(~kMailFull);
    next_mail();
  }

  void change_state(std::uint16_t status) {
    const auto asked = static_cast<std::uint16_t>(get16(0x120) & 0x0FU);
    const bool acknowledged = (get16(0x120) & kError) != 0;
    if ((status & kError) != 0 && !acknowledged) return;
    const auto now = static_cast<std::uint16_t>(status & 0x0FU);
    const bool up_one = (asked == kPreOperational && now >= kInit) ||
                        (asked == kSafeOperational && now >= kPreOperational) ||
                        (asked == kOperational && now >= kSafeOperational);
    std::uint16_t code = asked == refused_state ? 0x0001 : 0;
    if (asked != kInit && !up_one) code = 0x0011;
    if (code == 0 && asked == kSafeOperational && now == kPreOperational) {  // sync managers are as mapped
      const auto [outputs, inputs] = mapped_bytes();
      if (get16(output_manager() + 2) != outputs) code = 0x001D;
      if (get16(output_manager() + 10) != inputs) code = 0x001E;
    }
    if (code != 0) {
      set16(0x130, now | kError);
      set16(0x134, code);
      return;
    }
    outputs_left_ = asked == kOperational && now == kSafeOperational ? wanted_outputs : 0;
    if (outputs_left_ > 0) return;
    const bool stops = now == kOperational && asked != kOperational;
    set16(0x130, asked);
    set16(0x134, 0);
    silent_ticks_ = 0;
    if (stops) stopped();
  }

  void serve_eeprom() {
    const std::uint32_t at = get32(0x504);
    if ((memory_[0x503] & 0x01U) != 0) {  // read
      for (std::size_t i = 0; i < 2; ++i) set16(0x508 + 2 * i, eeprom_word(at + i));
    }
    set16(0x502, 0);
  }

  void logical_access(std::uint32_t address, std::span<std::uint8_t> data, bool reads, bool writes,
                      std::uint16_t& counter) {
    for (std::size_t f = 0; f < 4; ++f) {
      const std::size_t fmmu = 0x600 + 16 * f;
      if (memory_[fmmu + 12] == 0) continue;
      const std::uint32_t start = get32(fmmu), length = get16(fmmu + 4), physical = get16(fmmu + 8);
      if (start < address || start + length > address + data.size()) continue;
      const std::span<std::uint8_t> part = data.subspan(start - address, length);
      if (physical + length > memory_.size() || state() < kSafeOperational) continue;
      const std::span<std::uint8_t> mapped = std::span(memory_).subspan(physical, length);
      const bool input = (memory_[fmmu + 11] & 1U) != 0;
      const std::span<std::uint8_t> outputs =
          std::span(memory_).subspan(kOutputs, static_cast<std::size_t>(form_.output_bytes));
      if (input && reads && !gives_nothing) {
        if (physical == kInputs) give(mapped, outputs);
        std::ranges::copy(mapped, part.begin());
        counter = static_cast<std::uint16_t>(counter + 1);
      } else if (!input && writes && !takes_nothing) {
        std::ranges::copy(part, mapped.begin());
        counter = static_cast<std::uint16_t>(counter + (reads ? 2 : 1));
        silent_ticks_ = 0;
        const bool last = outputs_left_ == 1;
        if (outputs_left_ > 0) --outputs_left_;
        if (last) set16(0x130, kOperational);
        if (state() == kOperational) take(outputs);
      }
    }
  }

  SlaveForm form_;
  std::vector<std::uint8_t> memory_;
  std::vector<std::uint16_t> eeprom_;
  std::deque<std::pair<std::uint8_t, std::vector<std::uint8_t>>> mail_;
  int silent_ticks_ = 0, outputs_left_ = 0;
  std::int64_t clock_offset_ns_ = 0;
};

}  // namespace pmg::test
