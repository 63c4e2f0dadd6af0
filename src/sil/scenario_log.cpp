#include "sil/scenario_log.hpp"

#include <algorithm>
#include <iterator>

#include "pmg_msgs/scenario_step_t.hpp"

namespace pmg::sil {

void ScenarioLog::write(std::int64_t stamp_ns, std::size_t number) {
  if (number == last_) return;
  last_ = number;
  const ScenarioStep& step = scenario_.steps.at(number - 1);
  pmg_msgs::scenario_step_t message;
  message.stamp_ns = stamp_ns;
  message.scenario = scenario_.name;
  message.number = static_cast<std::int32_t>(number);
  message.step_count = static_cast<std::int32_t>(scenario_.steps.size());
  message.duration_s = step.duration_s;
  message.text = step.text;
  message.mode = static_cast<std::int8_t>(step.mode);
  for (std::size_t channel = 0; channel < kChannels; ++channel)
    message.command[channel] = step.command[static_cast<Channel>(channel)];
  log_.write_step(message);
}

}  // namespace pmg::sil
