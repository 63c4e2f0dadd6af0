// Whether a browser's request is for this server, and from one of its own pages.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pmg::web {

/// "Robot.local:8443" => "robot.local"; "[::1]:8443" => "::1". Nothing: no host and port.
std::optional<std::string> host_name(std::string_view host);

/// Whether a Host header names this server. A page of another site whose name was made to lead here (DNS rebinding)
/// names that site.
bool is_ours(std::string_view host, std::span<const std::string> names);

/// Whether an Origin header is that of a page that this server gave out: https, and the request's own Host.
bool is_own_origin(std::string_view origin, std::string_view host);

/// The WebSocket subprotocol that every page asks for, and the beginning of the one that carries a token.
inline constexpr std::string_view kProtocol = "pmg", kTokenProtocol = "pmg.token.";

struct AskedProtocols {
  bool ours = false;                 ///< kProtocol is among them
  std::optional<std::string> token;  ///< behind kTokenProtocol
};
/// Of a Sec-WebSocket-Protocol header: "pmg, pmg.token.6f1c...".
AskedProtocols asked_protocols(std::string_view header);

}  // namespace pmg::web
