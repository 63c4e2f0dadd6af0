#include "io/lcm_link.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace pmg::io {

namespace {

/// Messages of one channel that may wait for receive(); liblcm drops further ones.
constexpr int kQueueCapacity = 200;

}  // namespace

LcmLink::LcmLink(const std::string& url) : url_(url), lcm_(nullptr, &lcm_destroy) {
  const std::string checked = checked_lcm_url(url);
  lcm_.reset(lcm_create(checked.c_str()));
  if (lcm_ == nullptr)
    throw std::runtime_error("LCM address \"" + url + "\": LCM does not open it; see its lines above");
}

void LcmLink::subscribe(const std::string& channel, Handler handler) {
  Subscription& subscription = subscriptions_.emplace_back(std::move(handler), this);
  lcm_subscription_t* made = lcm_subscribe(lcm_.get(), channel.c_str(), &LcmLink::dispatch, &subscription);
  if (made == nullptr) {
    subscriptions_.pop_back();
    throw std::runtime_error("LCM address \"" + url_ +
                             "\": what this host sends does not come back to it; a firewall may drop multicast");
  }
  lcm_subscription_set_queue_capacity(made, kQueueCapacity);
}

void LcmLink::dispatch(const lcm_recv_buf_t* message, const char* /*channel*/, void* subscription) {
  auto& [handler, link] = *static_cast<Subscription*>(subscription);
  try {  // liblcm is C: nothing may be thrown through it
    handler({static_cast<const std::uint8_t*>(message->data), message->data_size});
  } catch (const std::exception&) {
    ++link->receive_errors_;
  }
}

bool LcmLink::send(const std::string& channel, Bytes bytes) noexcept {
  if (lcm_publish(lcm_.get(), channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) == 0) return true;
  ++publish_errors_;
  return false;
}

int LcmLink::receive(int timeout_ms, int max_messages) {
  int handled = 0;
  int wait_ms = timeout_ms;
  while (handled < max_messages) {
    // Without a descriptor (a tcpq server went away) liblcm's select would end the process; publishing reconnects.
    const bool connected = lcm_get_fileno(lcm_.get()) >= 0;
    const int result = connected ? lcm_handle_timeout(lcm_.get(), wait_ms) : -1;
    if (result == 0) break;
    if (result < 0) {
      ++receive_errors_;
      std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms));  // no busy loop on a broken network
      break;
    }
    ++handled;
    wait_ms = 0;
  }
  return handled;
}

}  // namespace pmg::io
