// SocketLink against a kernel's CAN. Without the interfaces can0 to can4 these tests are skipped: test/can/canrun makes
// them.
#include "can/socket_link.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <net/if.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "drives/message.hpp"
#include "generator_core/allocation_count.hpp"

namespace pmg::can {
namespace {

using testing::HasSubstr;

std::string refusal(const std::string& interface, bool fd = false) {
  try {
    const SocketLink link(interface, {}, fd);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "opened";
}

class Sockets : public testing::Test {
 protected:
  void SetUp() override {
    if (if_nametoindex("can4") == 0) GTEST_SKIP() << "this kernel has no interface can4: run test/can/canrun";
  }
  /// So many frames, which the kernel may deliver a moment after send(); fewer if they don't come within 1 s.
  static std::vector<drives::Message> receive(SocketLink& link, std::size_t expected = 0) {
    std::vector<drives::Message> frames(256);
    std::size_t count = link.receive(frames);
    pollfd polled{.fd = link.descriptor(), .events = POLLIN, .revents = 0};
    while (count < expected && poll(&polled, 1, 1000) > 0) count += link.receive(std::span(frames).subspan(count));
    frames.resize(count);
    return frames;
  }
};

TEST(SocketsOrNone, AKernelWithoutCanOrAMissingInterfaceIsOneLine) {
  EXPECT_THAT(
      refusal("can99"),
      testing::AnyOf("can99: this kernel has no CAN; expected one with the modules can and can_raw (modprobe can_raw)",
                     "can99: no such interface; expected a CAN interface (ip link show type can)"));
}

/// From here on this process gets no CAN socket, as in a container that grants none.
void forbid_can_sockets() {
  constexpr auto data = [](std::size_t at) { return static_cast<unsigned>(at); };
  sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, data(offsetof(seccomp_data, nr))),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_socket, 0, 3),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, data(offsetof(seccomp_data, args))),  // the low half of its first argument
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, PF_CAN, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | EPERM),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  const sock_fprog program = {.len = static_cast<unsigned short>(std::size(filter)), .filter = filter};
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  if (prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) != 0) std::_Exit(1);
}

// A kernel's CAN sockets are open to everybody; a container may refuse them. The child says what it got.
TEST(SocketsOrNone, WhereTheyAreForbiddenTheCapabilityIsNamed) {
  if (prctl(PR_GET_SECCOMP, 0, 0, 0, 0) < 0) GTEST_SKIP() << "this kernel has no filters of system calls";
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe(ends.data()), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    forbid_can_sockets();
    const std::string said = refusal("can0");
    std::_Exit(write(ends[1], said.data(), said.size()) == static_cast<ssize_t>(said.size()) ? 0 : 1);
  }
  close(ends[1]);
  std::array<char, 200> said{};
  const ssize_t bytes = read(ends[0], said.data(), said.size());
  close(ends[0]);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(std::string(said.data(), static_cast<std::size_t>(std::max<ssize_t>(bytes, 0))),
            "can0: no permission for CAN sockets; expected CAP_NET_RAW");
}

TEST_F(Sockets, WhatIsNoCanInterfaceOrIsDownIsRefused) {
  EXPECT_EQ(refusal("lo"), "lo: isn't a CAN interface; expected one of `ip link show type can`");
  EXPECT_THAT(refusal("a-name-that-is-too-long"), HasSubstr("isn't the name of an interface"));
  ASSERT_EQ(std::system("ip link set can4 down"), 0);  // NOLINT: a test's own kernel
  EXPECT_THAT(refusal("can4"), HasSubstr("can4: is down; expected it up: ip link set can4 up"));
  SocketLink open("can3", {}, false);
  ASSERT_EQ(std::system("ip link set can3 down"), 0);  // NOLINT
  const drives::Message frame = drives::Message::of(1, std::array<std::uint8_t, 2>{1, 2});
  open.send(std::span(&frame, 1));
  receive(open);
  EXPECT_EQ(open.health(), BusHealth::kOff);
  EXPECT_EQ(open.counts().not_sent, 1u);
  ASSERT_EQ(std::system("ip link set can3 up; ip link set can4 up"), 0);  // NOLINT
}

TEST_F(Sockets, FramesArriveWholeInOrderAndThroughTheFilter) {
  SocketLink host("can0", {0x10, 0x7FF}, true), drives("can0", {}, true);
  std::vector<drives::Message> sent;
  for (int i = 0; i < 70; ++i) {  // three batches
    std::array<std::uint8_t, 64> data{};
    for (std::size_t k = 0; k < data.size(); ++k) data[k] = static_cast<std::uint8_t>(i + static_cast<int>(k));
    sent.push_back(
        drives::Message::of(i % 2 == 0 ? 0x10 : 0x11, std::span(data).first(i % 3 == 0 ? 64 : 8), i % 3 == 0));
  }
  drives.send(sent);
  EXPECT_EQ(drives.counts().sent, 70u);
  const std::vector<drives::Message> got = receive(host, 35);
  ASSERT_EQ(got.size(), 35u) << "0x11 isn't awaited";
  for (std::size_t i = 0; i < got.size(); ++i) {
    const drives::Message& wanted = sent[2 * i];
    EXPECT_EQ(got[i].id, wanted.id);
    EXPECT_EQ(got[i].fd, wanted.fd);
    ASSERT_EQ(got[i].length, wanted.length);
    EXPECT_TRUE(std::ranges::equal(got[i].bytes(), wanted.bytes()));
  }
  EXPECT_TRUE(receive(drives).empty()) << "its own frames don't come back";
}

TEST_F(Sockets, ARecordingHasEveryFrameWithTheKernelsStamp) {
  SocketLink recorder("can2", {}, true), drives("can2", {}, true);
  const auto now_ns = [] { return std::chrono::system_clock::now().time_since_epoch().count(); };
  const std::int64_t before_ns = now_ns();
  const std::array<drives::Message, 2> frames = {
      drives::Message::of(0x044, std::array<std::uint8_t, 2>{0x2A, 0x36}),
      drives::Message::of(0x123, std::array<std::uint8_t, 2>{0xAA, 0xBB}, true)};
  drives.send(frames);
  can_frame remote{}, error{};
  remote.can_id = 0x123 | CAN_RTR_FLAG;
  remote.len = 4;
  error.can_id = CAN_ERR_FLAG | 0x4U;
  error.len = 8;
  error.data[1] = 4;
  for (const can_frame* frame : {&remote, &error})
    ASSERT_EQ(write(drives.descriptor(), frame, sizeof *frame), static_cast<ssize_t>(sizeof *frame));
  std::vector<std::string> lines;
  RecordedFrame recorded;
  pollfd polled{.fd = recorder.descriptor(), .events = POLLIN, .revents = 0};
  while (lines.size() < 4 && poll(&polled, 1, 1000) > 0) {
    while (recorder.record(recorded)) {
      EXPECT_GE(recorded.stamp_ns, before_ns);
      EXPECT_LE(recorded.stamp_ns, now_ns());
      recorded.stamp_ns = 1'500'000'000;
      lines.push_back(to_line(recorded));
    }
  }
  EXPECT_THAT(lines, testing::ElementsAre("(1.500000) can2 044#2A36", "(1.500000) can2 123##1AABB",
                                          "(1.500000) can2 123#R4", "(1.500000) can2 20000004#0004000000000000"));
}

TEST_F(Sockets, SendingAndReceivingAllocatesNothing) {
  SocketLink host("can1", {}, false), drives("can1", {}, false);
  std::array<drives::Message, 64> buffer;
  const std::array<drives::Message, 7> frames{};
  const long before = test::allocation_count();
  for (int k = 0; k < 50; ++k) {
    host.send(frames);
    pollfd polled{.fd = drives.descriptor(), .events = POLLIN, .revents = 0};
    for (std::size_t got = 0; got < frames.size() && poll(&polled, 1, 1000) > 0;) got += drives.receive(buffer);
  }
  EXPECT_EQ(test::allocation_count(), before);
  EXPECT_EQ(drives.counts().received, 350u);
}

}  // namespace
}  // namespace pmg::can
