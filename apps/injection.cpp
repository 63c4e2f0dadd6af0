#include "injection.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#ifdef PMG_SIL
#include "sil/failing_parts.hpp"
#include "sil/failure_report.hpp"
#endif

namespace pmg::apps {

#ifdef PMG_SIL

struct Injection::Parts {
  explicit Parts(std::vector<sil::Failure> listed) : failures(std::move(listed)), tick(failures, clock, true) {}
  std::vector<sil::Failure> failures;
  sil::FailureClock clock;
  sil::FailingTick tick;
  std::optional<sil::FailingBus> bus;
  std::vector<faults::Fault> faults;  // stamps by the failures' clock, which counts bus cycles
  faults::Fault last;
};

Injection::Injection(const std::filesystem::path& file, const std::string& hal, const model::RobotModel& robot) {
  if (file.empty()) return;
  if (hal != "sil") throw std::invalid_argument("--inject spoils simulated drives; expected --hal sil");
  parts_ = std::make_unique<Parts>(sil::load_failures(file, robot));
}

void Injection::into(control::LoadedControl& loaded) {
  if (!parts_) return;
  loaded.policy = std::make_unique<sil::FailingPolicy>(std::move(loaded.policy), parts_->failures, parts_->clock, true);
  loaded.options.spoiler = &parts_->tick;
}

hal::Hal& Injection::into(hal::Hal& drives, const model::RobotModel& robot) {
  if (!parts_) return drives;
  return parts_->bus.emplace(drives, parts_->failures, robot, parts_->clock, true);
}

void Injection::watch(const control::TickRecord& record) {
  if (!parts_) return;
  const faults::Fault& fault = record.result.fault;
  if (fault.code != faults::FaultCode::kNone && !faults::same_incident(fault, parts_->last)) {
    parts_->faults.push_back(fault);
    parts_->faults.back().stamp_ns = std::llround(1e9 * parts_->clock.now_s.load());
  }
  parts_->last = fault;
}

nlohmann::ordered_json Injection::report() const {
  if (!parts_ || !parts_->bus) return nlohmann::ordered_json::array();
  return sil::failures_json(parts_->failures, parts_->bus->reactions(), parts_->faults);
}

std::vector<std::string> Injection::lines() const {
  std::istringstream text(sil::failures_text(report()));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

#else

struct Injection::Parts {};

Injection::Injection(const std::filesystem::path& file, const std::string&, const model::RobotModel&) {
  if (!file.empty()) throw std::invalid_argument("--inject: this build has no simulated drives");
}
void Injection::into(control::LoadedControl&) {}
hal::Hal& Injection::into(hal::Hal& drives, const model::RobotModel&) { return drives; }
void Injection::watch(const control::TickRecord&) {}
nlohmann::ordered_json Injection::report() const { return nlohmann::ordered_json::array(); }
std::vector<std::string> Injection::lines() const { return {}; }

#endif

Injection::~Injection() = default;

}  // namespace pmg::apps
