// libFuzzer on what a page and a headset may say over their socket: texts are read whole and in their ranges, or
// refused. "scripts/fuzz page" builds and runs it.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
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

void judge(std::string_view text) {
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
}

/// Whole messages of these three thousandths, within their ranges or not: few changed texts stay whole.
void judge_numbers(const std::array<std::int16_t, 3>& x) {
  std::array<char, 800> text{};
  constexpr const char* kHand = R"({"n":1,"t":1,"held":true,"press":1,"forwards":%g,"turn":%g,"left":%g})";
  constexpr const char* kHeadset =
      R"({"vr":1,"t":1,"shown":true,"head":[%g,%g,%g,0,0,0,1],"left":{"pose":null,"leads":false,"presses":0,)"
      R"("backs":0},"right":{"pose":null,"leads":false,"presses":0,"backs":0},"held":true,"presses":1,"recentres":0,)"
      R"("spans":0,"uprights":0})";
  for (const char* form : {kHand, kHeadset}) {
    std::snprintf(text.data(), text.size(), form, 1e-3 * x[0], 1e-3 * x[1], 1e-3 * x[2]);
    judge(std::string_view(text.data()));
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes as the text that they are
  judge(std::string_view(reinterpret_cast<const char*>(data), size));
  std::array<std::int16_t, 3> numbers{};
  if (size < sizeof numbers) return 0;
  std::memcpy(numbers.data(), data, sizeof numbers);
  judge_numbers(numbers);
  return 0;
}
