#include "can/canopen_setup.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "drive_protocols/canopen_drive.hpp"

namespace pmg::can {

namespace {

constexpr std::uint32_t kOff = 0x80000000U;  // of a PDO's identifier
constexpr std::uint32_t kEventDriven = 255, kEverySync = 1;
constexpr std::uint16_t kReceiveSettings = 0x1400, kReceiveMap = 0x1600, kTransmitSettings = 0x1800,
                        kTransmitMap = 0x1A00;
constexpr int kPdos = 4;  // that drives have by default
constexpr int kStartWaits = 5;

constexpr std::uint32_t mapped(const drives::ObjectId& id) {
  return static_cast<std::uint32_t>(id.index) << 16U | static_cast<std::uint32_t>(id.subindex) << 8U | id.bytes * 8U;
}

/// One PDO: off, remapped, on.
struct Pdo {
  std::uint16_t settings, map;
  std::uint32_t identifier, type;
  std::vector<drives::ObjectId> objects;
};

void must_write(SdoClient& node, const drives::ObjectId& id, std::uint32_t value) {
  if (node.write(id, value)) return;
  throw std::runtime_error(
      fmt::format("has no object {} ; expected a drive whose PDOs can be mapped", drives::to_string(id)));
}

void set_up_pdo(SdoClient& node, const Pdo& pdo) {
  must_write(node, {pdo.settings, 1, 4}, kOff | pdo.identifier);
  must_write(node, {pdo.settings, 2, 1}, pdo.type);
  must_write(node, {pdo.map, 0, 1}, 0);
  std::uint8_t subindex = 0;
  for (const drives::ObjectId& object : pdo.objects) must_write(node, {pdo.map, ++subindex, 4}, mapped(object));
  must_write(node, {pdo.map, 0, 1}, subindex);
  must_write(node, {pdo.settings, 1, 4}, pdo.identifier);
}

void set_up_pdos(SdoClient& node, std::uint32_t number, const drives::Cia402Settings& settings) {
  namespace object = drives::object;
  for (std::uint16_t i = 0; i < kPdos; ++i) {  // drives without these send and take nothing there
    if (i > 0)
      node.write({static_cast<std::uint16_t>(kReceiveSettings + i), 1, 4}, kOff | (0x200U + 0x100U * i + number));
    if (i > 1)
      node.write({static_cast<std::uint16_t>(kTransmitSettings + i), 1, 4}, kOff | (0x180U + 0x100U * i + number));
  }
  set_up_pdo(node, {kReceiveSettings,
                    kReceiveMap,
                    drives::canopen::kReceive1 + number,
                    kEventDriven,
                    {object::kControlWord, object::kTargetPosition, object::kTargetTorque}});
  set_up_pdo(node, {kTransmitSettings,
                    kTransmitMap,
                    drives::canopen::kTransmit1 + number,
                    kEverySync,
                    {object::kStatusWord, object::kPosition, object::kTorque}});
  std::vector<drives::ObjectId> second = {object::kVelocity, object::kErrorCode};
  if (settings.temperature_index != 0) second.push_back({settings.temperature_index, settings.temperature_subindex, 2});
  set_up_pdo(node, {kTransmitSettings + 1, kTransmitMap + 1, drives::canopen::kTransmit2 + number, kEverySync, second});
}

}  // namespace

Wait sleeping() {
  return [] { std::this_thread::sleep_for(std::chrono::milliseconds(1)); };
}

std::optional<drives::canopen::SdoAnswer> SdoClient::ask(const drives::Message& request, const drives::ObjectId& id) {
  std::array<drives::Message, 64> frames;
  while (link_.receive(frames) > 0) {
  }
  for (int attempt = 0; attempt < kTries; ++attempt) {
    link_.send(std::span(&request, 1));
    std::optional<drives::canopen::SdoAnswer> found;
    for (int wait = 0; wait < kWaits && !found; ++wait) {
      wait_();
      const std::size_t count = link_.receive(frames);
      for (const drives::Message& frame : std::span(frames).first(count)) {
        if (frame.extended || frame.id != drives::canopen::kSdoAnswer + static_cast<std::uint32_t>(node_)) continue;
        const auto answer = drives::canopen::sdo_answer(frame);
        if (!answer || answer->id.index != id.index || answer->id.subindex != id.subindex) continue;
        found = answer;
      }
    }
    if (!found) continue;
    if (!found->aborted) return found;
    if (found->value == drives::canopen::kAbortNoObject || found->value == drives::canopen::kAbortNoSubindex)
      return std::nullopt;
    throw std::runtime_error(
        fmt::format("refuses object {} with SDO abort 0x{:08X}", drives::to_string(id), found->value));
  }
  throw std::runtime_error(
      fmt::format("does not answer about object {}; expected a powered CANopen drive with this "
                  "node number",
                  drives::to_string(id)));
}

std::optional<std::uint32_t> SdoClient::read(const drives::ObjectId& id) {
  const auto answer = ask(drives::canopen::sdo_read(node_, id), id);
  if (!answer) return std::nullopt;
  if (!answer->upload || !answer->expedited)
    throw std::runtime_error(fmt::format("gives no number as object {}", drives::to_string(id)));
  return answer->value;
}

bool SdoClient::write(const drives::ObjectId& id, std::uint32_t value) {
  return ask(drives::canopen::sdo_write(node_, id, value), id).has_value();
}

void set_up_node(const BusSetup& bus, const drives::MotorSetup& motor, Link& link, const Wait& wait) {
  const auto& settings = *drives::as_cia402(motor.drive);
  const auto command = [&](drives::canopen::NodeCommand what) {
    const drives::Message frame = drives::canopen::node_command(what, motor.node);
    link.send(std::span(&frame, 1));
    for (int k = 0; k < kStartWaits; ++k) wait();
  };
  try {
    SdoClient node(motor.node, link, wait);
    command(drives::canopen::NodeCommand::kPreOperational);
    drives::check_drive(node, settings);
    drives::set_up_drive(node, settings, motor.limits);
    set_up_pdos(node, static_cast<std::uint32_t>(motor.node), settings);
    must_write(node, {0x1016, 1, 4}, drives::canopen::kHostNode << 16U | drives::canopen::kHeartbeatTimeout_ms);
    node.write({0x1029, 1, 1}, 1);  // a silent computer stops the motor, not the node's PDOs; not every drive has it
    command(drives::canopen::NodeCommand::kStart);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(drives::name_of(bus, motor) + ": " + error.what());
  }
}

void set_up_nodes(const DriveSetup& setup, const std::vector<std::unique_ptr<Link>>& links, const Wait& wait,
                  const std::function<bool()>& interrupted) {
  for (std::size_t b = 0; b < setup.buses.size(); ++b) {
    for (const drives::MotorSetup& motor : setup.buses[b].motors) {
      if (drives::as_cia402(motor.drive) == nullptr) continue;
      if (interrupted && interrupted()) throw std::runtime_error("interrupted while the drives were set up");
      set_up_node(setup.buses[b], motor, *links[b], wait);
    }
  }
}

}  // namespace pmg::can
