#include "web/allowance.hpp"

#include <algorithm>

namespace pmg::web {

bool Allowance::take(std::int64_t now_ns) noexcept {
  if (taken_ns_ != 0) left_ = std::min(room_, left_ + per_s_ * static_cast<double>(now_ns - taken_ns_) * 1e-9);
  taken_ns_ = now_ns;
  if (left_ < 1.0) return false;
  left_ -= 1.0;
  return true;
}

}  // namespace pmg::web
