#include "live_page/page_state.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "arms_operator/arms_text.hpp"
#include "operator/robot_text.hpp"

namespace pmg::live_page {

namespace {

using Json = nlohmann::ordered_json;

/// Pure ASCII; broken UTF-8 of another program becomes U+FFFD.
std::string text_of(const Json& json) { return json.dump(-1, ' ', true, Json::error_handler_t::replace); }

/// Three digits are more than a picture shows.
double milli(double value) { return std::round(value * 1e3) / 1e3; }

}  // namespace

std::string shared_state(const ops::DrivingStation& station, const PageDevices& devices, const ops::ArmsBoard& arms,
                         const MeasuredMotion* measured, const HeardCamera* camera, std::int64_t now_ns) {
  const ops::RobotDriver* driver = station.driver();
  const ops::RobotNews* news = station.news();
  const double silence_s = news == nullptr ? 0.0 : static_cast<double>(now_ns - news->heard_ns) * 1e-9;
  Json json;
  json["at_s"] = milli(static_cast<double>(now_ns) * 1e-9);  // by the server's clock, so that a page sees what is late
  json["robot"] = driver == nullptr ? Json() : Json(driver->robot());
  json["text"] = driver == nullptr ? station.lines().front() : driver->text();
  json["heard"] = news != nullptr && silence_s <= ops::kGone_s;
  if (driver != nullptr) {
    json["asked"] = driver->asked().u;
    json["lower"] = devices.hands().limits().lower;
    json["upper"] = devices.hands().limits().upper;
    json["limited"] = driver->limited();
    json["driving"] = driver->driving();
  }
  if (news != nullptr) {
    json["news"] = ops::news_json(*news, silence_s);
    json["limits"] = ops::limits_text(*news);
    if (const ops::HeardArms* heard = arms.of(news->status.robot)) json["arms"] = ops::arms_lines(heard->state);
  }
  if (measured != nullptr && measured->channels()) json["measured"] = *measured->channels();
  if (measured != nullptr && measured->tilt() && news != nullptr && news->state) {
    const Eigen::Quaterniond& tilt = *measured->tilt();
    json["tilt"] = {milli(tilt.w()), milli(tilt.x()), milli(tilt.y()), milli(tilt.z())};
    for (const double q : news->state->q_rad) json["joints"].push_back(milli(q));
  }
  if (camera != nullptr) {
    const auto newest = camera->newest();
    json["camera"] = newest ? Json{{"number", newest->number}, {"age_s", milli(newest->age_s)}} : Json::object();
  }
  std::string text = text_of(json);
  text.pop_back();
  return text;
}

std::string page_state(const std::string& shared, const web::Page& page, const PageDevices& devices) {
  const Json you = {{"paired", page.paired_as}, {"drives", devices.drives(page.id)}, {"note", devices.note(page)}};
  return shared + ",\"you\":" + text_of(you) + "}";
}

}  // namespace pmg::live_page
