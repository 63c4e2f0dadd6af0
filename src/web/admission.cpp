#include "web/admission.hpp"

#include <algorithm>
#include <cctype>

namespace pmg::web {

namespace {

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return lower;
}

bool is_port(std::string_view text) {
  return !text.empty() && text.size() <= 5 && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::optional<std::string> host_name(std::string_view host) {
  std::string_view name = host, rest;
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    name = host.substr(1, end - 1);
    rest = host.substr(end + 1);
  } else if (const std::size_t colon = host.find(':'); colon != std::string_view::npos) {
    name = host.substr(0, colon);
    rest = host.substr(colon);
  }
  if (name.empty() || (!rest.empty() && (rest.front() != ':' || !is_port(rest.substr(1))))) return std::nullopt;
  return lower_case(name);
}

bool is_ours(std::string_view host, std::span<const std::string> names) {
  const auto name = host_name(host);
  return name && std::ranges::any_of(names, [&](const std::string& own) { return lower_case(own) == *name; });
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  return lower_case(origin) == "https://" + lower_case(host);
}

AskedProtocols asked_protocols(std::string_view header) {
  AskedProtocols asked;
  while (!header.empty()) {
    const std::size_t comma = header.find(',');
    std::string_view item = header.substr(0, comma);
    header = comma == std::string_view::npos ? std::string_view{} : header.substr(comma + 1);
    while (item.starts_with(' ') || item.starts_with('\t')) item.remove_prefix(1);
    while (item.ends_with(' ') || item.ends_with('\t')) item.remove_suffix(1);
    if (item == kProtocol) asked.ours = true;
    if (item.starts_with(kTokenProtocol)) asked.token = item.substr(kTokenProtocol.size());
  }
  return asked;
}

}  // namespace pmg::web
