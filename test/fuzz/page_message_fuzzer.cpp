// libFuzzer on what a page and a headset may say over their socket: texts are read whole and in their ranges, or
// refused. "scripts/fuzz page" builds and runs it.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "live_page/page_message.hpp"
#include "vr/vr_news.hpp"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void judge(const pmg::vr::Pose& pose) {
  require(pose.p_m.cwiseAbs().maxCoeff() <= 20.0);
  require(std::abs(pose.R.norm() - 1.0) < 1e-9);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes as the text that they are
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  if (const auto message = pmg::live_page::read_message(text)) {
    require(message->hand.has_value() != message->request.has_value());
    if (message->hand) {
      for (const double share : {message->hand->forwards, message->hand->turn, message->hand->left})
        require(std::abs(share) <= 1.0);
      require(message->hand->number >= 0 && message->hand->presses >= 0);
    }
  }
  if (const auto news = pmg::vr::read_news(text)) {
    if (news->head) judge(*news->head);
    for (const pmg::vr::HandNews& hand : {news->hands[pmg::kLeft], news->hands[pmg::kRight]}) {
      if (hand.pose) judge(*hand.pose);
      require(hand.lead_presses >= 0 && hand.hand_backs >= 0);
    }
    require(news->number >= 0 && news->presses >= 0 && news->recentres >= 0);
  }
  return 0;
}
