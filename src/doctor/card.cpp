// A network card that EtherCAT has for itself.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "doctor/checks.hpp"
#include "doctor/cpu_list.hpp"
#include "doctor/interface_flags.hpp"

namespace pmg::doctor {

namespace {

/// Numbers of the card's interrupts: of its device, or of lines in /proc/interrupts that have its name.
std::set<int> interrupts_of(const Host& host, const std::string& interface) {
  std::set<int> numbers;
  const auto add = [&numbers](const std::string& text) {
    int number = 0;
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    if (std::from_chars(text.data() + begin, text.data() + text.size(), number).ec == std::errc())
      numbers.insert(number);
  };
  for (const std::string& name : host.names(fmt::format("sys/class/net/{}/device/msi_irqs", interface))) add(name);
  if (!numbers.empty()) return numbers;
  std::istringstream lines(host.text("proc/interrupts").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    const std::string name = line.substr(line.find_last_of(' ') + 1);
    if (name == interface || name.starts_with(interface + "-")) add(line);
  }
  return numbers;
}

Finding link_finding(const Host& host, const std::string& interface) {
  const std::string check = interface + " link";
  const auto flags = interface_flags(host, interface);
  if (!flags) {
    return fail(interface + " link", "no such interface",
                fmt::format("plug the card in, or name another (this computer has {})",
                            fmt::join(host.names("sys/class/net"), ", ")));
  }
  if ((*flags & kInterfaceUp) == 0) return fail(check, "is down", fmt::format("as root: ip link set {} up", interface));
  if (host.text(fmt::format("sys/class/net/{}/carrier", interface)) != "1")
    return fail(check, "has no carrier", "plug the cable in, and power the first slave");
  return ok(check, "up, with carrier");
}

Finding address_finding(const Host& host, const std::string& interface) {
  const std::string check = interface + " address";
  const std::vector<std::string> addresses = host.addresses(interface);
  if (addresses.empty()) return ok(check, "none: nobody else sends there");
  const bool ipv4 =
      std::ranges::any_of(addresses, [](const std::string& text) { return text.find('.') != std::string::npos; });
  const std::string found =
      fmt::format("has {}; expected none: other programs' packets delay EtherCAT's", fmt::join(addresses, ", "));
  const std::string remedy = fmt::format(
      "as root: ip address flush dev {0}; sysctl -w net.ipv6.conf.{0}.disable_ipv6=1; take it out of NetworkManager",
      interface);
  return ipv4 ? fail(check, found, remedy) : warn(check, found, remedy);
}

Finding coalescing_finding(const Host& host, const std::string& interface, const Limits& limits) {
  const std::string check = interface + " coalescing";
  const auto told = host.coalescing(interface);
  if (!told) return ok(check, "the driver has none, or doesn't tell");
  const std::string remedy = fmt::format("as root: ethtool -C {} adaptive-rx off rx-usecs 0", interface);
  const std::string found = fmt::format("frames wait up to {} us for an interrupt", told->receive_us);
  if (told->receive_us >= limits.coalescing_fail_us) {
    return fail(check, found + fmt::format("; expected less than {} us", limits.coalescing_fail_us), remedy);
  }
  if (told->adaptive) return warn(check, "adaptive: the wait for an interrupt changes with the traffic", remedy);
  if (told->receive_us > limits.coalescing_warn_us)
    return warn(check, found + fmt::format("; expected {} us or less", limits.coalescing_warn_us), remedy);
  return ok(check, found);
}

Finding interrupt_finding(const Host& host, const std::string& interface, const RealtimeCpus& cpus) {
  const std::string check = interface + " interrupts";
  const std::set<int> numbers = interrupts_of(host, interface);
  if (numbers.empty()) return ok(check, "none that has its name");
  std::set<int> where;
  for (const int number : numbers) {
    const std::string folder = fmt::format("proc/irq/{}/", number);
    auto at = host.text(folder + "effective_affinity_list");
    if (!at || at->empty()) at = host.text(folder + "smp_affinity_list");
    where.merge(cpu_list(at.value_or("")));
  }
  const std::string found = fmt::format("on CPU {}", to_text(where));
  const auto to = [&numbers](int cpu) {
    return fmt::format(
        "as root: systemctl stop irqbalance; for i in {}; do echo {} > /proc/irq/$i/smp_affinity_list; done",
        fmt::join(numbers, " "), cpu);
  };
  const int elsewhere = std::max(cpus.bus, 0);
  if (cpus.control >= 0 && cpus.control != cpus.bus && where.contains(cpus.control))
    return fail(check, found + ", which the control thread has for itself", to(elsewhere));
  if (where.size() > 1)
    return warn(check, found + "; expected one CPU: a frame that changes its CPU is late", to(elsewhere));
  return ok(check, found);
}

}  // namespace

std::optional<unsigned> interface_flags(const Host& host, const std::string& interface) {
  const auto text = host.text(fmt::format("sys/class/net/{}/flags", interface));
  unsigned flags = 0;
  if (!text || !text->starts_with("0x")) return std::nullopt;
  std::from_chars(text->data() + 2, text->data() + text->size(), flags, 16);
  return flags;
}

Findings check_card(const Host& host, const std::string& interface, const RealtimeCpus& cpus, const Limits& limits) {
  const Finding link = link_finding(host, interface);
  if (link.found == "no such interface") return {link};
  return {link, address_finding(host, interface), coalescing_finding(host, interface, limits),
          interrupt_finding(host, interface, cpus)};
}

}  // namespace pmg::doctor
