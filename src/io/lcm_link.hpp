// A link to the LCM network: opens with clear errors, publishes without exceptions, receives in bounded steps.
#pragma once

#include <lcm/lcm.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/lcm_assembler.hpp"
#include "io/lcm_url.hpp"
#include "io/multicast_receiver.hpp"

namespace pmg::io {

/// The message in these bytes; nothing if they are of another type, cut short or too long, or hold impossible lengths.
/// Safe for foreign packets.
template <typename Message>
std::optional<Message> decode_message(Bytes bytes) {
  try {
    Message message{};
    const int size = static_cast<int>(bytes.size());
    if (message.decode(bytes.data(), 0, size) == size) return message;
  } catch (const std::exception&) {  // std::string and std::vector refuse a length that lcm-gen's code trusts
  }
  return std::nullopt;
}

/// For one thread, not a real-time one. Publishing goes through liblcm. On udpm:// a MulticastReceiver receives,
/// because liblcm's receiver doesn't survive hostile datagrams; on the other addresses liblcm receives.
class LcmLink {
 public:
  using Handler = std::function<void(Bytes)>;
  static constexpr int kDatagramsPerMessage = 4, kHandling_ms = 10;

  /// Throws as checked_lcm_url() does, and std::runtime_error if liblcm still fails to open the address.
  explicit LcmLink(const std::string& url);

  /// receive() calls the handler, and catches and counts its exceptions. The first subscription makes sure that this
  /// computer hears itself. Throws std::runtime_error.
  void subscribe(const std::string& channel, Handler handler);

  /// False, and counted, if the message could not be sent.
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
  /// Sends raw bytes. Another thread may call it, too.
  bool send(const std::string& channel, Bytes bytes) noexcept;

  /// Waits up to timeout_ms for a message, then handles the waiting ones, at most max_messages, and no more than
  /// kDatagramsPerMessage times as many datagrams; on udpm:// for no longer than timeout_ms and kHandling_ms. So a
  /// flood can't hold the caller, whatever its handlers cost. Returns the number of messages.
  int receive(int timeout_ms, int max_messages = 500);

  const std::string& url() const noexcept { return url_; }  ///< the constructor's argument
  std::int64_t publish_errors() const noexcept { return publish_errors_; }
  std::int64_t receive_errors() const noexcept { return receive_errors_; }        ///< includes errors of handlers
  const MulticastReceiver* receiver() const noexcept { return receiver_.get(); }  ///< null: liblcm receives

 private:
  struct Subscription {
    Handler handler;
    LcmLink* link;
  };
  static void dispatch(const lcm_recv_buf_t* message, const char* channel, void* subscription);
  void handle(const Handler& handler, Bytes bytes) noexcept;
  void expect_to_hear_itself();
  int receive_multicast(int timeout_ms, int max_messages);
  int receive_by_liblcm(int timeout_ms, int max_messages);

  std::string url_;
  std::optional<UdpmAddress> udpm_;
  std::unique_ptr<MulticastReceiver> receiver_;   // from the first subscription on, for udpm://
  std::vector<std::vector<Handler>> by_channel_;  // by the receiver's numbers
  std::vector<std::string> channels_;
  std::deque<Subscription> subscriptions_;  // liblcm keeps their addresses: destroyed after it
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm_;
  std::vector<std::uint8_t> buffer_;
  std::atomic<std::int64_t> publish_errors_ = 0;
  std::int64_t receive_errors_ = 0;
};

}  // namespace pmg::io
