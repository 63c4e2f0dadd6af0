#include "operator/arms_source.hpp"

#include <algorithm>
#include <array>

namespace pmg::ops {

namespace {

void fill(const PalmWish& palm, std::int8_t& wish, double (&p_m)[3], double (&orientation)[4]) {
  wish = palm.wish;
  std::copy_n(palm.p_m.data(), 3, p_m);
  std::ranges::copy(std::array{palm.R.w(), palm.R.x(), palm.R.y(), palm.R.z()}, orientation);
}

}  // namespace

ArmsSource::ArmsSource(OperatorSource& source) : source_(source) {
  message_.version = pmg_msgs::arms_t::VERSION;
  message_.source = source.name();
  message_.session = source.session();
}

void ArmsSource::send(const std::string& robot, const PerFoot<PalmWish>& palms, double lease_s) {
  message_.robot = robot;
  message_.stamp_ns = source_.clock().now_ns();
  ++message_.sequence;
  message_.lease_s = lease_s;
  fill(palms[kLeft], message_.left, message_.left_p_m, message_.left_orientation);
  fill(palms[kRight], message_.right, message_.right_p_m, message_.right_orientation);
  source_.send("ARMS", message_);
}

}  // namespace pmg::ops
