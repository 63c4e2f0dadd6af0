// The mapping of pages: (what they say) => a command and requests. One page drives at a time; any paired page stops.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "live_page/page_hand.hpp"
#include "operator/device.hpp"
#include "web/server.hpp"

namespace pmg::live_page {

class PageHands : public ops::Device {
 public:
  /// The pages that are open: the hands of others are gone.
  void look(std::span<const web::Page> open);
  /// Something else of this program drives the robot: its name; empty: nothing does. Meanwhile pages ask for nothing.
  void let_other_drive(std::string name) { other_ = std::move(name); }
  /// What a page said. A stop counts though its page is gone.
  void take(const web::Said& said, std::int64_t now_ns);

  ops::DeviceManner manner() const override;
  void set_limits(const CommandLimits& limits) noexcept override { limits_ = limits; }
  std::span<const ops::Hold> holds(std::int64_t now_ns) noexcept override;  ///< one for each page, with its id
  Command command(std::optional<std::int32_t> armed, std::int64_t now_ns) noexcept override;
  ops::Requests take_requests() noexcept override;
  void rest() noexcept override { driving_.reset(); }
  void upright() noexcept override {}  // pages command no posture

  std::optional<std::int32_t> driving() const noexcept { return driving_; }  ///< the page that drives
  const PageHand* hand(std::int32_t page) const;                             ///< null: it isn't paired, or gone
  const CommandLimits& limits() const noexcept { return limits_; }
  std::uint64_t malformed() const noexcept { return malformed_; }  ///< messages that were none

 private:
  void ask(PageHand& hand, ops::Request request);

  CommandLimits limits_;  // zero until they are known: then every command is zero
  std::map<std::int32_t, PageHand> hands_;
  std::vector<ops::Hold> holds_;
  std::optional<std::int32_t> driving_;
  ops::Requests requests_;
  std::string other_;
  std::uint64_t malformed_ = 0;
};

}  // namespace pmg::live_page
