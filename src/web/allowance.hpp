// How many messages one page may send: so many a second on average, with room for a few that a delay bunched.
#pragma once

#include <cstdint>

namespace pmg::web {

class Allowance {
 public:
  Allowance(double per_s, double room) : per_s_(per_s), room_(room), left_(room) {}

  /// Takes one; false: none is left.
  bool take(std::int64_t now_ns) noexcept;

 private:
  double per_s_, room_, left_;
  std::int64_t taken_ns_ = 0;
};

}  // namespace pmg::web
