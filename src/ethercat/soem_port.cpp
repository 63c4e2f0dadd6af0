#include "ethercat/soem_port.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include "io/clock.hpp"

namespace pmg::ethercat {

namespace {

constexpr std::size_t kEthernetHeader = 14;

static_assert(std::is_standard_layout_v<SoemPort>, "a pointer to its first member is a pointer to it");
SoemPort& port_of(ecx_portt* port) { return *reinterpret_cast<SoemPort*>(port); }

/// The answer to frame `index` into its receive buffer. Its working counter; EC_NOFRAME: none until the deadline.
int take_answer(SoemPort& port, uint8 index, std::int64_t deadline_ns) {
  std::array<std::uint8_t, kMostFrame> frame{};
  const io::WallClock clock;
  const auto sent = static_cast<std::size_t>(port.soem.txbuflength[index]);
  while (true) {
    const std::int64_t left_ns = deadline_ns - clock.now_ns();
    const std::size_t bytes = port.wire->receive(frame, std::max<std::int64_t>(left_ns, 0));
    if (bytes == 0) {
      if (left_ns <= 0) return EC_NOFRAME;
      continue;
    }
    // Same EtherCAT length, command and index as what was sent; anything else is no answer.
    const std::uint8_t* out = reinterpret_cast<const std::uint8_t*>(port.soem.txbuf[index]) + kEthernetHeader;
    const std::uint8_t* in = frame.data() + kEthernetHeader;
    if (bytes < sent || std::memcmp(in, out, 4) != 0) continue;
    std::memcpy(port.soem.rxbuf[index], in, sent - kEthernetHeader);
    port.soem.rxbufstat[index] = EC_BUF_COMPLETE;
    return in[sent - kEthernetHeader - 2] | in[sent - kEthernetHeader - 1] << 8;
  }
}

}  // namespace

std::unique_ptr<SoemPort> make_port(Wire& wire) {
  auto port = std::make_unique<SoemPort>();
  port->wire = &wire;
  for (auto& buffer : port->soem.txbuf) ec_setupheader(buffer);
  ec_setupheader(port->soem.txbuf2);
  return port;
}

}  // namespace pmg::ethercat

using pmg::ethercat::port_of;

extern "C" {

const uint16 priMAC[3] = {0x0101, 0x0101, 0x0101};
const uint16 secMAC[3] = {0x0404, 0x0404, 0x0404};

void ec_setupheader(void* buffer) {
  auto* bytes = static_cast<std::uint8_t*>(buffer);
  std::memset(bytes, 0xFF, 6);
  std::memset(bytes + 6, 0x01, 6);
  bytes[12] = 0x88;
  bytes[13] = 0xA4;
}

int ecx_setupnic(ecx_portt*, const char*, int) { return 0; }  // make_port() does it
int ecx_closenic(ecx_portt*) { return 0; }

uint8 ecx_getindex(ecx_portt* port) {
  std::uint8_t& next = port_of(port).next_index;
  next = static_cast<std::uint8_t>((next + 1) % EC_MAXBUF);
  port->rxbufstat[next] = EC_BUF_ALLOC;
  return next;
}

void ecx_setbufstat(ecx_portt* port, uint8 index, int state) { port->rxbufstat[index] = state; }

int ecx_outframe(ecx_portt* port, uint8 index, int) {
  port->rxbufstat[index] = EC_BUF_TX;
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(port->txbuf[index]);
  const auto length = static_cast<std::size_t>(port->txbuflength[index]);
  return port_of(port).wire->send({bytes, length}) ? static_cast<int>(length) : -1;
}

int ecx_outframe_red(ecx_portt* port, uint8 index) { return ecx_outframe(port, index, 0); }

int ecx_waitinframe(ecx_portt* port, uint8 index, int timeout_us) {
  const std::int64_t deadline_ns = pmg::io::WallClock().now_ns() + std::int64_t{1000} * timeout_us;
  return pmg::ethercat::take_answer(port_of(port), index, deadline_ns);
}

int ecx_srconfirm(ecx_portt* port, uint8 index, int timeout_us) {
  const pmg::io::WallClock clock;
  const std::int64_t deadline_ns = clock.now_ns() + std::int64_t{1000} * timeout_us;
  int counter = EC_NOFRAME;
  do {
    ecx_outframe(port, index, 0);
    counter = ecx_waitinframe(port, index, std::min(timeout_us, EC_TIMEOUTRET));
  } while (counter <= EC_NOFRAME && clock.now_ns() < deadline_ns);
  return counter;
}
}
