// Who of several controllers keeps a name. Only what was said after one's own question counts: no recording decides.
#pragma once

#include <cstdint>

#include "pmg_msgs/claim_t.hpp"

namespace pmg::runtime {

/// One controller's part, without its network. It asks with its boot number; whoever else has the name, or wants it,
/// answers with that number.
class NameContest {
 public:
  enum class Reaction {
    kNone,
    kAnswer,  ///< a question of another one
    kYield,   ///< the name is another one's
    kMet,     ///< we have the name, and another one has it, too
  };

  explicit NameContest(std::int64_t boot) noexcept : boot_(boot) {}

  void hold() noexcept { holds_ = true; }  ///< the name is ours from now on
  bool holds() const noexcept { return holds_; }

  /// (a claim to our name, its sender's boot number) => (what it calls for, if its proof is good).
  Reaction hear(const pmg_msgs::claim_t& claim, std::int64_t boot) const noexcept {
    if (boot == boot_) return Reaction::kNone;
    if (claim.answers == pmg_msgs::claim_t::NOBODY) return Reaction::kAnswer;
    if (claim.answers != boot_) return Reaction::kNone;  // another one's answer, or an earlier start's
    if (holds_) return Reaction::kMet;
    return claim.held != 0 || boot < boot_ ? Reaction::kYield : Reaction::kNone;
  }

 private:
  std::int64_t boot_;
  bool holds_ = false;
};

}  // namespace pmg::runtime
