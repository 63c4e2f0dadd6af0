// The way of LCM's messages, and who may drive.
#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <exception>
#include <sstream>

#include "doctor/checks.hpp"
#include "io/lcm_url.hpp"
#include "seal/controller_seal.hpp"

namespace pmg::doctor {

namespace {

/// The interface that the kernel sends this group's packets to, by its table (/proc/net/route); empty: none is told.
std::string interface_to(const Host& host, in_addr group) {
  std::istringstream lines(host.text("proc/net/route").value_or(""));
  std::string line, best;
  int longest = -1;
  std::getline(lines, line);  // the columns' names
  while (std::getline(lines, line)) {
    std::istringstream columns(line);
    std::string interface, gateway;
    std::uint32_t destination = 0, mask = 0, flags = 0;
    int skipped = 0;
    columns >> interface >> std::hex >> destination >> gateway >> flags >> std::dec >> skipped >> skipped >> skipped >>
        std::hex >> mask;
    if (!columns || (group.s_addr & mask) != destination || std::popcount(mask) <= longest) continue;
    longest = std::popcount(mask);
    best = interface;
  }
  return best;
}

}  // namespace

Findings check_multicast(const Host& host, const std::string& lcm_url, const std::vector<std::string>& cards) {
  const std::string check = "multicast route";
  if (const std::string problem = host.multicast_problem(lcm_url); !problem.empty()) {
    return {fail(check, problem, "as root: ip link set lo up multicast on; ip route add 224.0.0.0/4 dev lo")};
  }
  const auto address = io::udpm_address(lcm_url);
  if (!address) return {ok(check, fmt::format("{} needs none", lcm_url))};
  const std::string interface = interface_to(host, address->group);
  if (std::ranges::find(cards, interface) != cards.end()) {
    return {fail(check, fmt::format("LCM's messages go to {}, which EtherCAT has for itself", interface),
                 "as root: ip route add 224.0.0.0/4 dev lo (or dev of the operators' network)")};
  }
  if (interface == "lo" && io::leaves_this_computer(lcm_url)) {
    return {fail(check, fmt::format("{} is to reach other computers, and its route ends at lo", lcm_url),
                 "as root: ip route replace 224.0.0.0/4 dev NAME, the interface of the operators' network")};
  }
  return {ok(check, interface.empty() ? lcm_url : fmt::format("{} over {}", lcm_url, interface))};
}

Findings check_keys(const std::string& folder, const std::string& lcm_url, bool insecure) {
  const std::string check = "keys";
  const bool leaves = io::leaves_this_computer(lcm_url);
  const std::string make = "on this computer, as the user that runs pmg_controller: pmg_key new NAME --out NAME.key";
  try {
    if (insecure && leaves)
      return {warn(check, fmt::format("none are asked for: everybody who reaches {} can drive", lcm_url), make)};
    const std::filesystem::path where = folder.empty() ? seal::controller_folder() : std::filesystem::path(folder);
    const auto keys = seal::read_controller_keys(where);
    const bool needed = leaves || !folder.empty();
    if (needed && (!keys || keys->operators.empty()))
      return {fail(check, fmt::format("{} has no operator's key: nobody can drive", where.string()), make)};
    if (!needed) return {ok(check, "messages stay on this computer: none are needed")};
    return {ok(check,
               fmt::format("{} operator{} may drive", keys->operators.size(), keys->operators.size() == 1 ? "" : "s"))};
  } catch (const std::exception& error) {
    return {fail(check, error.what(),
                 "give the file to the user that runs pmg_controller and make it its alone (chmod 600), or " + make)};
  }
}

}  // namespace pmg::doctor
