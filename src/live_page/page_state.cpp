#include "live_page/page_state.hpp"

#include <nlohmann/json.hpp>

#include "arms_operator/arms_text.hpp"
#include "operator/robot_text.hpp"

namespace pmg::live_page {

namespace {

using Json = nlohmann::ordered_json;

/// Pure ASCII; broken UTF-8 of another program becomes U+FFFD.
std::string text_of(const Json& json) { return json.dump(-1, ' ', true, Json::error_handler_t::replace); }

/// Why a finger on this page's stick doesn't drive; empty: it does, or there is none.
std::string note_of(const web::Page& page, const PageHands& hands, const ops::DrivingStation& station) {
  const PageHand* hand = hands.hand(page.id);
  if (hand == nullptr) return "";
  if (hand->late()) return "this page's messages come late: it can't drive";
  if (!hand->note().empty()) return hand->note();
  const auto driving = hands.driving();
  const PageHand* driver = driving && *driving != page.id ? hands.hand(*driving) : nullptr;
  if (driver != nullptr) return driver->name() + " drives the robot";
  if (station.driver() != nullptr && station.driver()->hold().refused(page.id))
    return "let go of the stick and touch it anew";
  return "";
}

}  // namespace

std::string shared_state(const ops::DrivingStation& station, const PageHands& hands, const ops::ArmsBoard& arms,
                         const MeasuredMotion* measured, std::int64_t now_ns) {
  const ops::RobotDriver* driver = station.driver();
  const ops::RobotNews* news = station.news();
  const double silence_s = news == nullptr ? 0.0 : static_cast<double>(now_ns - news->heard_ns) * 1e-9;
  Json json;
  json["robot"] = driver == nullptr ? Json() : Json(driver->robot());
  json["text"] = driver == nullptr ? station.lines().front() : driver->text();
  json["heard"] = news != nullptr && silence_s <= ops::kGone_s;
  if (driver != nullptr) {
    json["asked"] = driver->asked().u;
    json["lower"] = hands.limits().lower;
    json["upper"] = hands.limits().upper;
    json["limited"] = driver->limited();
    json["driving"] = driver->driving();
  }
  if (news != nullptr) {
    json["news"] = ops::news_json(*news, silence_s);
    json["limits"] = ops::limits_text(*news);
    if (const ops::HeardArms* heard = arms.of(news->status.robot)) json["arms"] = ops::arms_lines(heard->state);
  }
  if (measured != nullptr && measured->channels()) json["measured"] = *measured->channels();
  std::string text = text_of(json);
  text.pop_back();
  return text;
}

std::string page_state(const std::string& shared, const web::Page& page, const PageHands& hands,
                       const ops::DrivingStation& station) {
  const Json you = {
      {"paired", page.paired_as}, {"drives", hands.driving() == page.id}, {"note", note_of(page, hands, station)}};
  return shared + ",\"you\":" + text_of(you) + "}";
}

}  // namespace pmg::live_page
