// CAN interfaces against what robot.yaml says of their buses.
#include <fmt/format.h>
#include <linux/can/netlink.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "doctor/checks.hpp"
#include "doctor/interface_flags.hpp"

namespace pmg::doctor {

namespace {

/// CiA 301's, which the kernel takes where nobody says another.
double recommended_sample_point(int bitrate) { return bitrate > 800'000 ? 0.75 : bitrate > 500'000 ? 0.8 : 0.875; }

/// The command that sets an interface as robot.yaml has its bus.
std::string set_up(const can::BusSetup& bus) {
  std::string text = fmt::format("as root: ip link set {0} down; ip link set {0} up txqueuelen 64 type can bitrate {1}",
                                 bus.name, bus.bitrate);
  if (bus.sample_point > 0.0) text += fmt::format(" sample-point {:g}", bus.sample_point);
  if (bus.data_bitrate != 0) text += fmt::format(" dbitrate {} fd on", bus.data_bitrate);
  if (bus.data_bitrate != 0 && bus.data_sample_point > 0.0)
    text += fmt::format(" dsample-point {:g}", bus.data_sample_point);
  return text + " restart-ms 100";
}

/// told: robot.yaml's; 0: not said. Nullopt: it is as expected.
std::optional<Finding> wrong_sample_point(const can::BusSetup& bus, const CanTiming& timing, int bitrate, double told,
                                          const char* phase, const Limits& limits) {
  const double is = timing.sample_permille / 1000.0, expected = told > 0.0 ? told : recommended_sample_point(bitrate);
  constexpr double kRounding = 1e-9;
  if (std::abs(is - expected) <= limits.sample_point_step + kRounding) return std::nullopt;
  const std::string check = bus.name + " sample point";
  const std::string found = fmt::format("{:.1f} %{}; expected {:.1f} %, as {}", 100.0 * is, phase, 100.0 * expected,
                                        told > 0.0 ? "robot.yaml says" : "CiA 301 recommends");
  const std::string also = "; all drives of the bus need the same";
  return told > 0.0 ? fail(check, found, set_up(bus))
                    : warn(check, found,
                           set_up(bus) + also + fmt::format(", or write it into robot.yaml: buses.{}", bus.name));
}

Finding sample_finding(const can::BusSetup& bus, const CanLink& link, const Limits& limits) {
  if (const auto wrong = wrong_sample_point(bus, link.arbitration, bus.bitrate, bus.sample_point, "", limits))
    return *wrong;
  // In the data phase CiA recommends nothing that holds for every transceiver: robot.yaml alone decides.
  if (bus.data_bitrate != 0 && bus.data_sample_point > 0.0) {
    if (const auto wrong =
            wrong_sample_point(bus, link.data, bus.data_bitrate, bus.data_sample_point, " in the data phase", limits))
      return *wrong;
  }
  return ok(bus.name + " sample point", fmt::format("{:.1f} %", link.arbitration.sample_permille / 10.0));
}

Finding state_finding(const can::BusSetup& bus, const CanLink& link) {
  const std::string check = bus.name + " state";
  const std::uint32_t state = link.state.value_or(CAN_STATE_MAX);
  const std::string wiring = "look at wires and termination (60 Ohm between CAN_H and CAN_L), power the drives, then: ";
  if (state == CAN_STATE_BUS_OFF)
    return fail(check, "bus-off: nothing is sent", wiring + set_up(bus).substr(std::strlen("as root: ")));
  if (state == CAN_STATE_STOPPED || state == CAN_STATE_SLEEPING) return fail(check, "stopped", set_up(bus));
  if (state == CAN_STATE_ERROR_PASSIVE)
    return warn(check, "error-passive: nobody acknowledges, or the wiring is bad", wiring + "pmg_bus scan");
  if (state == CAN_STATE_ERROR_WARNING)
    return warn(check, "error-warning: frames were disturbed", wiring + "pmg_bus scan");
  if (link.restart_ms == 0)
    return warn(check, "error-active; a bus that goes off stays off, as restart-ms is 0", set_up(bus));
  return state == CAN_STATE_ERROR_ACTIVE ? ok(check, "error-active") : warn(check, "isn't told", "pmg_bus scan");
}

Finding queue_finding(const Host& host, const can::BusSetup& bus) {
  const std::string check = bus.name + " queue";
  const std::string text = host.text(fmt::format("sys/class/net/{}/tx_queue_len", bus.name)).value_or("");
  std::size_t length = 0;
  std::from_chars(text.data(), text.data() + text.size(), length);
  const std::size_t burst = bus.motors.size() + 2;  // one frame a motor, SYNC and heartbeat
  if (length >= burst) return ok(check, fmt::format("room for {} frames", length));
  return fail(check,
              fmt::format("room for {} frames; a cycle sends up to {} at once, and the rest is lost", length, burst),
              fmt::format("as root: ip link set {} txqueuelen 64", bus.name));
}

}  // namespace

Finding bitrate_finding(const can::BusSetup& bus, const CanLink& link) {
  const std::string check = bus.name + " bit rate";
  const auto differs = [](std::uint32_t is, int wanted) { return is != static_cast<std::uint32_t>(wanted); };
  if (differs(link.arbitration.bitrate, bus.bitrate)) {
    return fail(check, fmt::format("{} bit/s; robot.yaml says {}", link.arbitration.bitrate, bus.bitrate), set_up(bus));
  }
  if (bus.data_bitrate != 0 && differs(link.data.bitrate, bus.data_bitrate)) {
    return fail(check,
                fmt::format("{} bit/s in the data phase; robot.yaml says {}", link.data.bitrate, bus.data_bitrate),
                set_up(bus));
  }
  return ok(check, bus.data_bitrate == 0 ? fmt::format("{} bit/s", bus.bitrate)
                                         : fmt::format("{} and {} bit/s", bus.bitrate, bus.data_bitrate));
}

Findings check_can_bus(const Host& host, const can::BusSetup& bus, const Limits& limits) {
  int error = 0;
  const auto link = host.can_link(bus.name, error);
  if (!link && error == ENODEV)
    return {fail(bus.name, "no such interface", "plug the adapter in, and load its driver (ip link show type can)")};
  if (!link) return {warn(bus.name, fmt::format("the kernel doesn't tell: {}", std::strerror(error)), set_up(bus))};
  if (link->kind != "can" && host.text(fmt::format("sys/class/net/{}/type", bus.name)) != "280") {  // ARPHRD_CAN
    return {fail(bus.name, "isn't a CAN interface", "name another in robot.yaml's `buses` (ip link show type can)")};
  }
  const auto flags = interface_flags(host, bus.name);
  if (!flags || (*flags & kInterfaceUp) == 0) return {fail(bus.name, "is down", set_up(bus))};
  Findings findings = {ok(bus.name, "up")};
  if (link->kind != "vcan") findings.push_back(queue_finding(host, bus));  // a virtual one hands frames on at once
  if (link->kind == "can") {
    findings.push_back(bitrate_finding(bus, *link));
    findings.push_back(sample_finding(bus, *link, limits));
    findings.push_back(state_finding(bus, *link));
  } else {
    findings.push_back(warn(
        bus.name + " bit rate", fmt::format("an interface of the kind '{}' has none that could be read", link->kind),
        "nothing, if this is to try things out; else compare the adapter's settings with robot.yaml"));
  }
  return findings;
}

}  // namespace pmg::doctor
