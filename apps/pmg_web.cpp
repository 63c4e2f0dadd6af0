// pmg_web: a live page for phones and laptops, which shows a robot, stops it and drives it.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arms/arm_setup.hpp"
#include "arms_operator/arms_board.hpp"
#include "io/lcm_link.hpp"
#include "io/plain_text.hpp"
#include "live_page/assets.hpp"
#include "live_page/foxglove_feed.hpp"
#include "live_page/heard_camera.hpp"
#include "live_page/page_state.hpp"
#include "live_page/robot_shape.hpp"
#include "operator/driving_station.hpp"
#include "option_checks.hpp"
#include "program.hpp"
#include "seal/private_file.hpp"
#include "web/foxglove_server.hpp"
#include "web/own_names.hpp"
#include "web/pairings.hpp"
#include "web/server.hpp"

namespace {

using namespace pmg;
namespace fs = std::filesystem;

enum ExitCode { kOk = 0, kNone = 1 };

constexpr const char* kFooter = R"(
Everybody who reaches the address may look. Only a paired page stops the robot, asks for modes and drives: "pair" prints a link
that holds its token, for one phone, laptop or headset. A pairing that is revoked ends within a second. The certificate is made once by
this computer for itself, so a browser warns at the first visit: compare the fingerprint.

Without --listen only this computer is served. One page drives at a time, while a finger is on its stick; any paired page stops.
Software stops are not safety-rated.

Examples:
  pmg_web pair phone
  pmg_web --robot z1 --listen 0.0.0.0
  pmg_web --robot z1 --foxglove 8765
  pmg_web --robot z1 --camera

Exit codes: 0 done, or ended with Ctrl-C or by a signal: velocity was brought to zero first; 1 revoke: nothing is paired under this name;
2 bad input, no network, or a file that can't be used.)";

struct Arguments {
  std::string robot, lcm_url, keys, folder, name, listen = "127.0.0.1";
  std::vector<std::string> hosts, foxglove_origins;
  std::uint16_t port = 8443;
  std::optional<std::uint16_t> foxglove_port;
  bool camera = false;
};

fs::path folder_of(const Arguments& arguments) {
  return arguments.folder.empty() ? seal::config_folder() / "web" : fs::path(arguments.folder);
}

std::vector<std::string> names_of(const Arguments& arguments) {
  std::vector<std::string> names = arguments.hosts;
  for (std::string& name : web::own_names()) names.push_back(std::move(name));
  return names;
}

/// Links by which a browser gets here. here: those that lead nowhere on other computers.
std::vector<std::string> links(const Arguments& arguments, std::uint16_t port, bool here) {
  std::vector<std::string> links;
  for (const std::string& name : names_of(arguments)) {
    if ((name == "localhost" || name == "127.0.0.1" || name == "::1") != here) continue;
    links.push_back(fmt::format("https://{}:{}/", name.find(':') == std::string::npos ? name : "[" + name + "]", port));
  }
  return links;
}

int pair(const Arguments& arguments) {
  const std::string token = web::Pairings(folder_of(arguments) / "pairings").make(arguments.name);
  std::cout << fmt::format("{} is paired. Open one of these links on it; each holds the secret token:\n",
                           arguments.name);
  for (const bool here : {false, true})
    for (const std::string& link : links(arguments, arguments.port, here))
      std::cout << "  " << link << '#' << token << '\n';
  return kOk;
}

int list(const Arguments& arguments) {
  for (const std::string& name : web::Pairings(folder_of(arguments) / "pairings").names()) std::cout << name << '\n';
  return kOk;
}

int revoke(const Arguments& arguments) {
  if (web::Pairings(folder_of(arguments) / "pairings").revoke(arguments.name)) return kOk;
  std::cerr << fmt::format("pmg_web: nothing is paired as {}\n", io::plain_text(arguments.name));
  return kNone;
}

/// What is known of the robot once the controller names its model: this computer must have its files.
class KnownRobot {
 public:
  void take(const ops::RobotNews* news) {
    if (news == nullptr || !news->info) return;
    if (session_ != news->info->session) begin(*news->info);
    if (motion_) motion_->take(*news);
  }

  const live_page::MeasuredMotion* motion() const { return motion_ ? &*motion_ : nullptr; }  ///< null: none is measured
  const model::RobotModel* model() const { return motion_ ? &*models_.back() : nullptr; }    ///< stays
  double arm_span() const { return span_m_; }  ///< [m]; 0: it has no arms that can be led
  /// What a page draws of it, once after it has become known; empty: nothing new.
  std::string take_shape() { return std::exchange(shape_, {}); }

 private:
  void begin(const pmg_msgs::robot_info_t& info) {
    session_ = info.session;
    motion_.reset();
    span_m_ = 0.0;
    try {
      const model::RobotModel& robot = *models_.emplace_back(
          std::make_unique<const model::RobotModel>(model::load_robot(model::find_robot(info.model))));
      if (robot.joint_index.names() != info.joint_names) throw std::runtime_error("its joints are others");
      motion_.emplace(robot);
      const auto setup = arms::read_arm_setup(robot);
      span_m_ = setup ? arms::span_m(*setup) : 0.0;
      shape_ = live_page::robot_shape(robot);
    } catch (const std::exception& error) {
      std::cerr << fmt::format("pmg_web: no measured motion is shown: model {}: {}\n", io::plain_text(info.model),
                               io::plain_text(error.what()));
    }
  }

  std::optional<std::int64_t> session_;
  std::vector<std::unique_ptr<const model::RobotModel>> models_;  // one for each start of a controller
  std::optional<live_page::MeasuredMotion> motion_;
  double span_m_ = 0.0;
  std::string shape_;
};

/// The robot's topics for Foxglove on this computer, if it was asked for.
class FoxgloveDoor {
 public:
  FoxgloveDoor(const Arguments& arguments, io::LcmLink& link) {
    if (!arguments.foxglove_port) return;
    const auto utc_ns = [] {
      return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
    };
    server_.emplace(web::FoxgloveSettings{
        .port = *arguments.foxglove_port, .session = std::to_string(utc_ns()), .origins = arguments.foxglove_origins});
    feed_.emplace(link, *server_, utc_ns);
    std::cout << fmt::format("Foxglove: ws://localhost:{}\n", server_->port());
  }
  void follow(const ops::RobotNews* news, const model::RobotModel* model) {
    if (feed_) feed_->follow(news != nullptr && news->info ? &*news->info : nullptr, model);
  }

 private:
  std::optional<web::FoxgloveServer> server_;
  std::optional<live_page::FoxgloveFeed> feed_;
};

/// What the robot's camera shows, for pages, if it was asked for.
class CameraDoor {
 public:
  CameraDoor(const Arguments& arguments, io::LcmLink& link, const io::Clock& clock, web::Server& server)
      : server_(server) {
    if (arguments.camera) heard_.emplace(link, clock);
  }
  void follow(const ops::RobotDriver* driver) {
    if (!heard_) return;
    heard_->follow(driver == nullptr ? "" : driver->robot());
    if (auto picture = heard_->take()) server_.give_out({"/camera.jpg", "image/jpeg", std::move(*picture)});
  }
  const live_page::HeardCamera* heard() const { return heard_ ? &*heard_ : nullptr; }

 private:
  web::Server& server_;
  std::optional<live_page::HeardCamera> heard_;
};

/// Closes the pages of names that are no longer paired.
void end_revoked(web::Server& server, const std::vector<std::string>& paired) {
  for (const web::Page& page : server.pages())
    if (!page.paired_as.empty() && std::ranges::find(paired, page.paired_as) == paired.end()) server.close(page.id);
}

int serve(const Arguments& arguments) {
  constexpr int kWait_ms = 5;
  constexpr std::int64_t kPicture_ns = 50'000'000, kLook_ns = 500'000'000;
  const io::WallClock clock;
  io::LcmLink link(io::choose_lcm_url(arguments.lcm_url));
  const seal::OperatorSeal seal = seal::load_operator_seal(arguments.keys, link.url());
  live_page::PageDevices devices;
  ops::DrivingStation station(link, devices.device(), arguments.robot, ops::session_number(), clock, seal);
  ops::ArmsBoard arms(link, clock, seal);
  KnownRobot known;
  const web::Pairings pairings(folder_of(arguments) / "pairings");
  const std::vector<std::string> names = names_of(arguments);
  const web::Certificate certificate = web::load_certificate(folder_of(arguments), names, std::time(nullptr));
  web::Server server({.address = arguments.listen,
                      .port = arguments.port,
                      .certificate = certificate,
                      .names = names,
                      .assets = live_page::assets(),
                      .paired = [&pairings](std::string_view token) { return pairings.find(token); }});
  apps::notice({SIGINT, SIGTERM}, nullptr);
  const bool here = arguments.listen == "127.0.0.1" || arguments.listen == "::1";
  for (const std::string& one : links(arguments, server.port(), here))
    if (!here || (one.find("[::1]") == std::string::npos) == (arguments.listen != "::1")) std::cout << one << '\n';
  std::cout << "fingerprint of the certificate (SHA-256): " << certificate.fingerprint << '\n';
  FoxgloveDoor foxglove(arguments, link);
  CameraDoor camera(arguments, link, clock, server);
  if (pairings.names().empty()) std::cout << "nothing is paired: pmg_web pair NAME\n";
  std::cout << std::flush;
  std::int64_t show_at_ns = 0, look_at_ns = 0;
  while (!station.gone()) {
    if (apps::interrupt_requested != 0) station.let_go();
    const std::vector<web::Page> pages = server.pages();
    devices.look(pages, clock.now_ns());
    devices.learn(arms.of(station.driver() == nullptr ? "" : station.driver()->robot()));
    for (const web::Said& said : server.take()) devices.take(said, clock.now_ns());
    station.step(kWait_ms);
    known.take(station.news());
    foxglove.follow(station.news(), known.model());
    camera.follow(station.driver());
    devices.set_robot_span(known.arm_span());
    if (std::string shape = known.take_shape(); !shape.empty())
      server.give_out({"/robot.json", "application/json", std::move(shape)});
    const std::int64_t now_ns = clock.now_ns();
    if (now_ns >= look_at_ns) {
      look_at_ns = now_ns + kLook_ns;
      end_revoked(server, pairings.names());
    }
    if (now_ns < show_at_ns || pages.empty()) continue;
    show_at_ns = now_ns + kPicture_ns;
    const std::string shared = live_page::shared_state(station, devices, arms, known.motion(), camera.heard(), now_ns);
    for (const web::Page& page : pages) server.show(page.id, live_page::page_state(shared, page, devices));
  }
  std::cout << station.last_words() << '\n';
  return kOk;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Serves a live page that shows a robot, stops it and drives it.", "pmg_web");
  Arguments arguments;
  app.footer(kFooter);
  app.require_subcommand(0, 1);
  app.add_option("--robot", arguments.robot, "controller's name; may be left out when one is heard");
  app.add_option("--listen", arguments.listen,
                 "IP address of the interface that is served; 0.0.0.0: all; this computer alone if not given");
  app.add_option("--port", arguments.port, "TCP port; 0: any free one")
      ->check(apps::in_range(0, 65535))
      ->capture_default_str();
  app.add_option("--host", arguments.hosts, "another name by which browsers call this computer; may be repeated");
  app.add_option("--foxglove", arguments.foxglove_port,
                 "also serve the robot's topics to Foxglove on this TCP port of this computer alone; 0: any free one; "
                 "Foxglove looks for 8765")
      ->check(apps::in_range(0, 65535));
  app.add_option("--foxglove-origin", arguments.foxglove_origins,
                 "another site whose pages may look at these topics: https://HOST; may be repeated");
  app.add_flag(
      "--camera", arguments.camera,
      "also show everybody who looks what the robot's camera sends; of a simulated robot: pmg_controller --hal "
      "sil --camera");
  app.add_option("--lcm-url", arguments.lcm_url,
                 fmt::format("LCM address; LCM_DEFAULT_URL or {} if not given", io::kDefaultLcmUrl));
  app.add_option("--keys", arguments.keys, "folder of this operator's keys; ~/.config/pmg/operator-keys if not given");
  app.add_option("--folder", arguments.folder, "folder of certificate and pairings; ~/.config/pmg/web if not given");
  app.add_subcommand("pair", "pair a phone, a laptop or a headset, and print its link")
      ->fallthrough()
      ->add_option("NAME", arguments.name, "its name")
      ->required();
  app.add_subcommand("list", "print what is paired")->fallthrough();
  app.add_subcommand("revoke", "end a pairing")
      ->fallthrough()
      ->add_option("NAME", arguments.name, "its name")
      ->required();
  return apps::run_program(app, argc, argv, [&]() -> int {
    if (app.get_subcommands().empty()) return serve(arguments);
    const std::string request = app.get_subcommands().front()->get_name();
    if (request == "pair") return pair(arguments);
    return request == "list" ? list(arguments) : revoke(arguments);
  });
}
