// CPUs that the two real-time threads have for themselves, and the frequency of all.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <map>
#include <sstream>

#include "doctor/checks.hpp"
#include "doctor/cpu_list.hpp"

namespace pmg::doctor {

namespace {

constexpr int kMostCpus = 4096;

std::set<int> cpus_in(const Host& host, const std::string& name) {
  return cpu_list(host.text("sys/devices/system/cpu/" + name).value_or(""));
}

/// Two CPUs that could be reserved: the last two.
std::string suggestion(const std::set<int>& online) {
  if (online.size() < 4) return "";
  return fmt::format("{},{}", *std::next(online.rbegin()), *online.rbegin());
}

Finding isolation(const Host& host, const RealtimeCpus& cpus) {
  const std::string check = "isolated CPUs";
  const std::set<int> online = cpus_in(host, "online"), isolated = cpus_in(host, "isolated"),
                      quiet = cpus_in(host, "nohz_full");
  std::set<int> wanted;
  for (const int cpu : {cpus.bus, cpus.control}) {
    if (cpu >= 0) wanted.insert(cpu);
  }
  for (const int cpu : wanted) {
    if (online.contains(cpu)) continue;
    return fail(check, fmt::format("CPU {} is asked for; this computer has {}", cpu, to_text(online)),
                "give --bus-cpu and --control-cpu CPUs of this computer");
  }
  if (isolated.empty()) {
    const std::string two = suggestion(online);
    return warn(
        check, "none: every other program delays the two real-time threads",
        two.empty()
            ? "a computer with four CPUs or more could reserve two; this one has too few"
            : fmt::format("boot with isolcpus={0} nohz_full={0} rcu_nocbs={0} on the kernel's command line", two));
  }
  if (wanted.empty()) {
    return warn(check, fmt::format("{} isolated, and nothing runs there", to_text(isolated)),
                fmt::format("start with --bus-cpu {} --control-cpu {}", *isolated.begin(), *isolated.rbegin()));
  }
  for (const int cpu : wanted) {
    if (!isolated.contains(cpu))
      return warn(check, fmt::format("CPU {} is shared with every other program", cpu),
                  fmt::format("use the isolated ones, {}, or boot with isolcpus={}", to_text(isolated),
                              fmt::join(wanted, ",")));
    if (!quiet.contains(cpu))
      return warn(check, fmt::format("CPU {} is isolated, and the scheduler's clock still interrupts it", cpu),
                  fmt::format("boot with nohz_full={} on the kernel's command line", fmt::join(wanted, ",")));
  }
  if (cpus.bus == cpus.control)
    return warn(check, fmt::format("bus and control thread share CPU {}", cpus.bus), "give each a CPU of its own");
  return ok(check, fmt::format("{} for the real-time threads alone", to_text(wanted)));
}

Finding frequency(const Host& host) {
  const std::string check = "CPU frequency";
  std::map<std::string, std::set<int>> by_governor;
  bool own = false;  // the driver's "powersave" chooses a frequency by the load, and isn't the lowest one
  for (const int cpu : cpus_in(host, "online")) {
    const std::string folder = fmt::format("sys/devices/system/cpu/cpu{}/cpufreq/", cpu);
    if (const auto governor = host.text(folder + "scaling_governor")) by_governor[*governor].insert(cpu);
    const std::string driver = host.text(folder + "scaling_driver").value_or("");
    own = own || driver == "intel_pstate" || driver.starts_with("amd-pstate");
  }
  if (by_governor.empty()) return ok(check, "this computer doesn't change it, or doesn't tell");
  by_governor.erase("performance");
  if (by_governor.empty()) return ok(check, "governor performance on every CPU");
  const auto& [governor, where] = *by_governor.begin();
  const std::string found = fmt::format("governor {} on CPU {}; expected performance", governor, to_text(where));
  const std::string remedy = "as root: echo performance | tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor";
  if (governor == "powersave" && !own) return fail(check, found + ": it stays at its lowest frequency", remedy);
  return warn(check, found, remedy);
}

/// What interrupts this CPU beside the kernel's own clock: "eth0 (39)".
std::vector<std::string> devices_on(const Host& host, const std::set<int>& cpus) {
  std::vector<std::string> found;
  std::istringstream lines(host.text("proc/interrupts").value_or(""));
  for (std::string line; std::getline(lines, line);) {
    int number = 0;
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    const auto [end, error] = std::from_chars(line.data() + begin, line.data() + line.size(), number);
    if (error != std::errc() || end == line.data() + line.size() || *end != ':') continue;  // LOC:, RES:, ...
    const std::string folder = fmt::format("proc/irq/{}/", number);
    auto at = host.text(folder + "effective_affinity_list");
    if (!at || at->empty()) at = host.text(folder + "smp_affinity_list");
    for (const int cpu : cpu_list(at.value_or(""))) {
      if (!cpus.contains(cpu)) continue;
      found.push_back(fmt::format("{} ({})", line.substr(line.find_last_of(' ') + 1), number));
      break;
    }
  }
  return found;
}

Finding interrupts(const Host& host, const RealtimeCpus& cpus) {
  const std::string check = "interrupts of other devices";
  std::set<int> wanted;
  for (const int cpu : {cpus.bus, cpus.control}) {
    if (cpu >= 0) wanted.insert(cpu);
  }
  if (wanted.empty()) return ok(check, "no CPU is reserved that they could disturb");
  std::vector<std::string> there = devices_on(host, wanted);
  if (there.empty()) return ok(check, fmt::format("none on CPU {}", to_text(wanted)));
  const std::size_t count = there.size();
  there.resize(std::min<std::size_t>(count, 4));
  return warn(
      check,
      fmt::format("{} on CPU {}: {}{}", count, to_text(wanted), fmt::join(there, ", "), count > 4 ? ", ..." : ""),
      "as root: systemctl stop irqbalance; write another CPU into /proc/irq/NUMBER/smp_affinity_list; or boot "
      "with irqaffinity=0");
}

}  // namespace

std::set<int> cpu_list(const std::string& text) {
  std::set<int> cpus;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    int first = 0, last = 0;
    const char* const end = part.data() + part.size();
    const auto [dash, error] = std::from_chars(part.data(), end, first);
    if (error != std::errc()) continue;
    last = first;
    if (dash != end && *dash == '-') std::from_chars(dash + 1, end, last);
    for (int cpu = first; cpu <= last && cpu < kMostCpus; ++cpu) cpus.insert(cpu);
  }
  return cpus;
}

std::string to_text(const std::set<int>& cpus) { return fmt::format("{}", fmt::join(cpus, ", ")); }

Findings check_cpus(const Host& host, const RealtimeCpus& cpus) {
  return {isolation(host, cpus), frequency(host), interrupts(host, cpus)};
}

}  // namespace pmg::doctor
