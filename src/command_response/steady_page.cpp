// The page of the steady commands.
#include <fmt/format.h>

#include <algorithm>

#include "command_response/steady.hpp"

namespace pmg::command_response {

std::vector<pages::Table> tables_of(const SteadyTest& test) {
  pages::Table table{
      .header = {"command", "asked vx, vy [m/s], omega [rad/s]", "admitted", "did", "error", "drift", "limit", ""},
      .rows = {}};
  const auto three = [](const Command& u) { return fmt::format("{:.3f}, {:.3f}, {:.3f}", u[kVx], u[kVy], u[kOmega]); };
  for (std::size_t i = 0; i < test.commands.size(); ++i) {
    const HeldCommand& asked = test.commands[i];
    const HeldResult& result = test.results[i];
    if (!result.complete) continue;
    table.rows.push_back({asked.text, three(asked.command), three(result.admitted), three(result.did),
                          fmt::format("{:.1f} %", 100.0 * worst_error(asked, result.did)),
                          fmt::format("{:.1f} %", 100.0 * worst_drift(asked, result.did, test.limits)),
                          asked.drift_limit
                              ? fmt::format("{:.0f} %, drift {:.0f} %", 100.0 * asked.limit, 100.0 * *asked.drift_limit)
                              : fmt::format("{:.0f} %", 100.0 * asked.limit),
                          test.reached(i)   ? "reached"
                          : result.survived ? "missed"
                                            : "fell or faulted"});
  }
  return {table};
}

pages::Page page_of(const SteadyTest& test) {
  pages::Page page(fmt::format("Steady commands: {} on {}", test.candidate.name, test.robot));
  page.worth(worth_of(test));
  std::size_t reached = 0;
  for (std::size_t i = 0; i < test.commands.size(); ++i) reached += test.reached(i) ? 1 : 0;
  page.verdict(worth_of(test).usable() ? work::Worth() : work::Worth(work::Grade::kMissed, "see the table"),
               fmt::format("{} of {} commands are realised within their limit", reached, test.commands.size()));
  page.heading("Commands");
  pages::Bars bars{.title = "largest error of a channel [% of its command]", .unit = "%", .names = {}, .sets = {}};
  pages::Bars::Set by_policy{.name = "the robot", .values = {}},
      by_generator{.name = "the command that the generator admits", .values = {}, .colour = pages::colour::kGrey};
  for (std::size_t i = 0; i < test.commands.size(); ++i) {
    const HeldCommand& asked = test.commands[i];
    const HeldResult& result = test.results[i];
    if (!result.complete) continue;
    bars.names.push_back(asked.text);
    by_policy.values.push_back(100.0 * worst_error(asked, result.did));
    by_generator.values.push_back(100.0 * worst_error(asked, result.admitted));
  }
  bars.sets = {by_policy, by_generator};
  page.bars(bars);
  for (const pages::Table& table : tables_of(test)) page.table(table);
  page.heading("How it was measured");
  page.paragraph(fmt::format(
      "One robot as the model says holds each command for {:.0f} s; the last {:.0f} s are averaged. Velocities are "
      "those of the pelvis in its heading frame. The error is the largest of the commanded channels, as a share of its "
      "command. The drift is the largest velocity of the other channels, as a share of its range. \"Admitted\" is the "
      "command that the generator took: what it cuts off is not the policy's error, but the robot's all the same.",
      test.settle_s + test.steady_s, test.steady_s));
  return page;
}

}  // namespace pmg::command_response
