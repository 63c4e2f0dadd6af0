// What a diagnosis said of one plant of the literature, against the truth.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "score.hpp"

namespace pmg::literature {

struct Judgement {
  Score score;                ///< of causes against planted effects
  bool counts = false;        ///< clean, or every planted effect or fault moves the bench by two noise floors
  bool fault_named = false;   ///< its kind is among data_faults, or an effect that would make the same files is found
  bool fault_placed = false;  ///< and its runs are those that have it
  bool false_cause = false;   ///< verdict found, and a cause or a data fault that isn't there
  bool false_fault = false;   ///< a data fault that isn't there
  bool right = false;         ///< as its stratum asks
  /// residual_extension: whether its error on left-out data is below that of the model without it; absent without one.
  std::optional<bool> extension_better;
  std::string law, planted, said;  ///< for people
  double floors = 0.0;             ///< of the weakest planted effect or fault
};

struct FaultJudgement {
  bool named = false, placed = false, false_fault = false;  ///< as Judgement has them, of data_faults alone
};

/// (truth, diagnosis.json or its data_faults alone) => (what data_faults says, against the truth).
FaultJudgement judge_faults(const nlohmann::json& truth, const nlohmann::json& diagnosis);

/// result: a line that a campaign wrote.
Judgement judge(const nlohmann::json& result);

/// The faults planted or said, for people.
std::string planted_text(const nlohmann::json& truth);
std::string said_text(const nlohmann::json& diagnosis);

}  // namespace pmg::literature
