// A CAN adapter on a serial line, as the kernel's driver slcan sees it: its other end is this object. So tests make the
// kernel's CAN controller report states and errors.
#pragma once

#include <fcntl.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "drives/message.hpp"

namespace pmg::test {

class SlcanAdapter {
 public:
  SlcanAdapter() {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) return;
    slave_ = open(ptsname(master_), O_RDWR | O_NOCTTY);  // NOLINT(concurrency-mt-unsafe)
    const int discipline = 17;                           // N_SLCAN
    ifreq name{};
    if (slave_ < 0 || ioctl(slave_, TIOCSETD, &discipline) != 0 || ioctl(slave_, SIOCGIFNAME, &name) != 0) return;
    interface_ = static_cast<const char*>(name.ifr_name);
    set_up();
  }
  ~SlcanAdapter() {
    if (slave_ >= 0) close(slave_);
    if (master_ >= 0) close(master_);
  }
  SlcanAdapter(const SlcanAdapter&) = delete;
  SlcanAdapter& operator=(const SlcanAdapter&) = delete;

  const std::string& interface() const { return interface_; }  ///< empty: this kernel has no slcan
  void set_up() const { run("up"); }
  void restart() const {
    run("down");
    run("up");
  }

  /// Frames that the kernel sent, until `count` have come or a second has passed.
  std::vector<drives::Message> sent(std::size_t count) {
    std::vector<drives::Message> frames;
    pollfd polled{.fd = master_, .events = POLLIN, .revents = 0};
    while (frames.size() < count && poll(&polled, 1, 1000) > 0) {
      std::string bytes(4096, '\0');
      const ssize_t got = read(master_, bytes.data(), bytes.size());
      if (got <= 0) break;
      text_.append(bytes, 0, static_cast<std::size_t>(got));
      for (std::size_t end = text_.find('\r'); end != std::string::npos; end = text_.find('\r')) {
        if (text_[0] == 't') frames.push_back(parse(text_));
        text_.erase(0, end + 1);
      }
    }
    return frames;
  }
  /// A frame from the bus.
  void hear(const drives::Message& frame) {
    constexpr const char* kDigits = "0123456789ABCDEF";
    std::string line = "t";
    for (const unsigned shift : {8U, 4U, 0U}) line += kDigits[frame.id >> shift & 0xFU];
    line += kDigits[frame.length & 0xFU];
    for (const std::uint8_t byte : frame.bytes()) line += {kDigits[byte >> 4U], kDigits[byte & 0xFU]};
    say(line);
  }
  /// A state of the controller: "sa000000" error-active, "sp128000" error-passive, "sb256256" bus-off; errors: "e1a",
  /// an ACK error.
  void say(const std::string& line) {
    const std::string ended = line + "\r";
    [[maybe_unused]] const ssize_t written = write(master_, ended.data(), ended.size());
  }

 private:
  void run(const std::string& state) const {
    const std::string command = "ip link set " + interface_ + " " + state;
    [[maybe_unused]] const int code = std::system(command.c_str());  // NOLINT: a test's own kernel
  }
  static drives::Message parse(const std::string& line) {
    drives::Message frame;
    frame.id = static_cast<std::uint32_t>(std::stoul(line.substr(1, 3), nullptr, 16));
    frame.length = static_cast<std::uint8_t>(line[4] - '0');
    for (std::size_t i = 0; i < frame.length; ++i)
      frame.data[i] = static_cast<std::uint8_t>(std::stoul(line.substr(5 + 2 * i, 2), nullptr, 16));
    return frame;
  }

  int master_ = -1, slave_ = -1;
  std::string interface_, text_;
};

}  // namespace pmg::test
