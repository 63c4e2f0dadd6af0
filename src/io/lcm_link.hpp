// One place on the LCM network: opened with clear errors, published to without exceptions, received from in bounded
// steps.
#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/lcm_url.hpp"

namespace pmg::io {

using Bytes = std::span<const std::uint8_t>;

/// The message in these bytes; nothing when they are of another type, cut short, too long, or claim sizes that can't
/// be: whatever a stranger sends.
template <typename Message>
std::optional<Message> decode_message(Bytes bytes) {
  try {
    Message message{};
    const int size = static_cast<int>(bytes.size());
    if (message.decode(bytes.data(), 0, size) == size) return message;
  } catch (const std::exception&) {  // lcm-gen's code trusts lengths: std::string and std::vector object
  }
  return std::nullopt;
}

/// For one thread, and not a real-time one. The first subscription starts liblcm's own receiving thread, which inherits
/// the caller's scheduling: subscribe before any real-time scheduling is asked for.
class LcmLink {
 public:
  using Handler = std::function<void(Bytes)>;

  /// Throws as checked_lcm_url() does, and std::runtime_error when liblcm doesn't open it all the same.
  explicit LcmLink(const std::string& url);

  /// handler is called from receive(); an exception that it throws ends there, counted. Throws std::runtime_error.
  void subscribe(const std::string& channel, Handler handler);

  /// False when the message could not be sent; counted.
  template <typename Message>
  bool publish(const std::string& channel, const Message& message) noexcept {
    try {
      const int size = message.getEncodedSize();
      buffer_.resize(static_cast<std::size_t>(size));
      if (message.encode(buffer_.data(), 0, size) == size) return send(channel, buffer_);
    } catch (const std::exception&) {  // no memory
    }
    ++publish_errors_;
    return false;
  }
  /// Bytes as they are: for tests of what a stranger may send.
  bool send(const std::string& channel, Bytes bytes) noexcept;

  /// Waits up to timeout_ms for a message, then handles what is there, at most max_messages: a flood doesn't keep the
  /// caller. Returns how many.
  int receive(int timeout_ms, int max_messages = 500);

  const std::string& url() const noexcept { return url_; }  ///< as it was given
  std::int64_t publish_errors() const noexcept { return publish_errors_; }
  std::int64_t receive_errors() const noexcept { return receive_errors_; }  ///< those of handlers included

 private:
  struct Subscription {
    Handler handler;
    LcmLink* link;
  };
  static void dispatch(const lcm_recv_buf_t* message, const char* channel, void* subscription);

  std::string url_;
  std::deque<Subscription> subscriptions_;  // liblcm keeps their addresses: destroyed after it
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm_;
  std::vector<std::uint8_t> buffer_;
  std::int64_t publish_errors_ = 0, receive_errors_ = 0;
};

}  // namespace pmg::io
