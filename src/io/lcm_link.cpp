#include "io/lcm_link.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

namespace pmg::io {

namespace {

/// Messages of one channel that may wait for receive(); liblcm drops further ones.
constexpr int kQueueCapacity = 200;

constexpr const char* kSelfTest = "LCM_SELF_TEST";  // liblcm's own channel for the same purpose
constexpr int kSelfTestTries = 20, kSelfTestWait_ms = 50;

constexpr std::size_t kDescriptors = 6;  // of liblcm's and our sockets, pipes included

/// Throws and names the limit, whose effects otherwise look like a defect of the address or a firewall.
void expect_free_descriptors(const std::string& url, std::size_t count) {
  std::vector<int> probes;
  int error = 0;
  while (probes.size() < count && error == 0) {
    const int probe = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (probe < 0) {
      error = errno;
    } else {
      probes.push_back(probe);
    }
  }
  for (const int probe : probes) ::close(probe);
  if (error != EMFILE && error != ENFILE) return;
  throw std::runtime_error("LCM address \"" + url + "\": " + std::strerror(error) +
                           "; expected room for more files and sockets (ulimit -n)");
}

}  // namespace

LcmLink::LcmLink(const std::string& url) : url_(url), lcm_(nullptr, &lcm_destroy) {
  expect_free_descriptors(url, kDescriptors);
  const std::string checked = checked_lcm_url(url);
  udpm_ = udpm_address(checked);
  lcm_.reset(lcm_create(checked.c_str()));
  if (lcm_ == nullptr)
    throw std::runtime_error("LCM address \"" + url + "\": LCM does not open it; see its lines above");
}

void LcmLink::subscribe(const std::string& channel, Handler handler) {
  if (udpm_) {
    if (!receiver_) expect_to_hear_itself();
    const auto known = std::ranges::find(channels_, channel);
    const auto number = static_cast<std::size_t>(known - channels_.begin());
    if (known == channels_.end()) {
      receiver_->want(channel);
      channels_.push_back(channel);
      by_channel_.emplace_back();
    }
    by_channel_[number].push_back(std::move(handler));
    return;
  }
  Subscription& subscription = subscriptions_.emplace_back(std::move(handler), this);
  lcm_subscription_t* made = lcm_subscribe(lcm_.get(), channel.c_str(), &LcmLink::dispatch, &subscription);
  if (made == nullptr) {
    subscriptions_.pop_back();
    throw std::runtime_error("LCM address \"" + url_ + "\": liblcm takes no subscription");
  }
  lcm_subscription_set_queue_capacity(made, kQueueCapacity);
}

void LcmLink::expect_to_hear_itself() {
  const auto trial = std::make_unique<MulticastReceiver>(url_, *udpm_);
  trial->want(kSelfTest);
  std::random_device random;
  std::array<std::uint8_t, 16> token{};
  for (std::uint8_t& byte : token) byte = static_cast<std::uint8_t>(random());
  for (int attempt = 0; attempt < kSelfTestTries; ++attempt) {
    lcm_publish(lcm_.get(), kSelfTest, token.data(), static_cast<unsigned>(token.size()));
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kSelfTestWait_ms);
    while (std::chrono::steady_clock::now() < end) {
      trial->wait(kSelfTestWait_ms);
      std::optional<LcmMessage> message;
      if (!trial->take(message) || !message || !std::ranges::equal(message->payload, token)) continue;
      receiver_ = std::make_unique<MulticastReceiver>(url_, *udpm_);
      return;
    }
  }
  expect_free_descriptors(url_, 1);
  throw std::runtime_error("LCM address \"" + url_ +
                           "\": what this host sends does not come back to it; a firewall may drop multicast");
}

void LcmLink::handle(const Handler& handler, Bytes bytes) noexcept {
  try {
    handler(bytes);
  } catch (const std::exception&) {
    ++receive_errors_;
  }
}

void LcmLink::dispatch(const lcm_recv_buf_t* message, const char* /*channel*/, void* subscription) {
  auto& [handler, link] = *static_cast<Subscription*>(subscription);
  // liblcm is C: nothing may be thrown through it
  link->handle(handler, {static_cast<const std::uint8_t*>(message->data), message->data_size});
}

bool LcmLink::send(const std::string& channel, Bytes bytes) noexcept {
  if (lcm_publish(lcm_.get(), channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) == 0) return true;
  ++publish_errors_;
  return false;
}

int LcmLink::receive(int timeout_ms, int max_messages) {
  if (!udpm_) return receive_by_liblcm(timeout_ms, max_messages);
  if (receiver_) return receive_multicast(timeout_ms, max_messages);
  std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
  return 0;
}

int LcmLink::receive_multicast(int timeout_ms, int max_messages) {
  using std::chrono::steady_clock;
  const auto end = steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  const auto last = end + std::chrono::milliseconds(kHandling_ms);
  int handled = 0;
  for (int datagrams = 0; handled < max_messages && datagrams < max_messages * kDatagramsPerMessage; ++datagrams) {
    if (datagrams > 0 && steady_clock::now() >= last) break;
    std::optional<LcmMessage> message;
    const std::int64_t errors = receiver_->errors();
    if (!receiver_->take(message)) {
      receive_errors_ += receiver_->errors() - errors;
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - steady_clock::now()).count();
      if (handled > 0 || left <= 0) break;
      receiver_->wait(static_cast<int>(left));
      continue;
    }
    if (!message) continue;
    ++handled;
    for (const Handler& handler : by_channel_[message->channel]) handle(handler, message->payload);
  }
  return handled;
}

int LcmLink::receive_by_liblcm(int timeout_ms, int max_messages) {
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
