#include "diagnosis_page/effect_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "diagnosis/direct_evidence.hpp"
#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {

namespace {

using diagnosis::Cause;
using diagnosis::DiagnosedRuns;
using diagnosis::Diagnosis;
using diagnosis::LookedAt;
using diagnosis::Rejected;
using evidence::Agreement;
using evidence::Signature;

/// The cause that has this name, or may have it; null if there is none.
const Cause* cause_of(const Diagnosis& diagnosis, const std::string& effect) {
  for (const Cause& cause : diagnosis.causes) {
    if (cause.effect == effect || effects::contains(cause.or_instead, effect) ||
        effects::contains(cause.same_here, effect))
      return &cause;
  }
  return nullptr;
}

const Rejected* rejected(const Diagnosis& diagnosis, const std::string& effect) {
  const auto found = std::find_if(diagnosis.rejected.begin(), diagnosis.rejected.end(),
                                  [&](const Rejected& one) { return one.effect == effect; });
  return found == diagnosis.rejected.end() ? nullptr : &*found;
}

/// The same check, of the simulated joint with all causes, has this agreement.
bool simulation(Agreement agreement, const Signature& check, const DiagnosedRuns& runs) {
  return std::any_of(runs.expected.begin(), runs.expected.end(), [&](const Signature& one) {
    return one.effect == check.effect && one.check == check.check && one.agreement == agreement;
  });
}

bool another_check_shows(const Signature& check, const DiagnosedRuns& runs) {
  return std::any_of(runs.checks.begin(), runs.checks.end(), [&](const Signature& one) {
    return one.effect == check.effect && one.agreement == Agreement::kAgrees;
  });
}

std::string of_a_cause(const Signature& check, const Cause& cause, const DiagnosedRuns& runs) {
  std::string as = cause.effect == check.effect ? "named as a cause"
                   : effects::contains(cause.same_here, check.effect)
                       ? fmt::format("on this rig the same as {}, which is named", effects::title(cause.effect))
                       : fmt::format("may be the cause instead of {}", effects::title(cause.effect));
  if (check.agreement == Agreement::kAgrees) return as;
  if (simulation(Agreement::kDisagrees, check, runs))
    return as + ": this check doesn't see it in the simulated joint either, which has the causes";
  if (another_check_shows(check, runs)) return as + ": another check shows it";
  return as + ": the fit shows it more clearly than this check can deny it";
}

std::string shown_and_no_cause(const Signature& check, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  if (simulation(Agreement::kAgrees, check, runs)) {
    return diagnosis.causes.empty()
               ? "no cause: the simulated joint shows it as well, so the simulation lacks nothing of it"
               : "no cause: the simulated joint with the causes above shows it as well, so they explain it";
  }
  const Rejected* why = rejected(diagnosis, check.effect);
  if (diagnosis::in_base(check.effect, diagnosis.before.actuator))
    return "no cause: the simulation has this effect already, and this check counts all of it";
  if (why == nullptr) return "not settled: the diagnosis says nothing about this effect";
  if (why->looked_at == LookedAt::kRecordings) return "no cause: " + why->why;
  if (why->looked_at == LookedAt::kFit)
    return fmt::format("not settled: the check shows it, but as a part of the simulation it was rejected ({})",
                       why->why);
  return fmt::format("not settled: the check shows it, and it was not tried in full ({})", why->why);
}

std::string words(Agreement agreement) {
  return agreement == Agreement::kAgrees      ? "show it"
         : agreement == Agreement::kDisagrees ? "don't show it"
                                              : "can't tell";
}

/// What all checks of an effect that is no cause say, in a cell.
std::string of_the_checks(const std::string& effect, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  std::string text;
  for (const Signature& check : runs.checks) {
    if (check.effect != effect || check.agreement == Agreement::kCannotTell) continue;
    text += fmt::format("{}{}: {}; {}", text.empty() ? "" : ". ", check.check, words(check.agreement),
                        beside_the_result(check, diagnosis, runs));
  }
  return text;
}

}  // namespace

std::string beside_the_result(const Signature& check, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  if (check.agreement == Agreement::kCannotTell) return "";
  if (const Cause* cause = cause_of(diagnosis, check.effect)) return of_a_cause(check, *cause, runs);
  if (check.agreement == Agreement::kAgrees) return shown_and_no_cause(check, diagnosis, runs);
  return "no sign of it, as in the result";
}

void show_no_causes(pages::Page& page, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  pages::Table ruled_out{.header = {"effect", "why it is no cause", "what the recordings alone say"}, .rows = {}};
  pages::Table open{
      .header = {"effect", "why we can't say", "what the recordings alone say", "a recording shows it with"},
      .rows = {}};
  for (const Rejected& one : diagnosis.rejected) {
    const std::string checks = of_the_checks(one.effect, diagnosis, runs);
    if (one.looked_at == LookedAt::kFit || one.looked_at == LookedAt::kRecordings) {
      ruled_out.rows.push_back({effects::title(one.effect), one.why, checks});
    } else {
      open.rows.push_back({effects::title(one.effect), one.why, checks, effects::effect(one.effect).needs});
    }
  }
  if (!ruled_out.rows.empty()) {
    page.heading("Ruled out");
    page.paragraph("We looked at these effects closely: they are no causes, or too small to matter here.");
    page.table(ruled_out);
  }
  if (open.rows.empty()) return;
  page.heading("Not ruled out");
  page.paragraph(fmt::format(
      "We did not look at these effects closely, as others promised more. They may be in the joint all the same.{}",
      diagnosis.verdict == evidence::Verdict::kUnexplained
          ? ""
          : " But what the simulation still misses is no larger than noise, so in these recordings they are small."));
  page.table(open);
}

void show_checks(pages::Page& page, const Diagnosis& diagnosis, const DiagnosedRuns& runs) {
  if (runs.checks.empty()) return;
  page.heading("Checks without a simulation");
  page.paragraph(
      "What the recordings alone say; values with their 95 % intervals. A check sees everything that the joint has, "
      "also "
      "what its simulation has already. The third column says how that goes together with the result.");
  pages::Table table{.header = {"effect", "the recordings", "and the result", "looked at", "value", "in words"},
                     .rows = {}};
  for (const Signature& check : runs.checks) {
    const evidence::Interval& v = check.value;
    table.rows.push_back({effects::title(check.effect), words(check.agreement),
                          beside_the_result(check, diagnosis, runs), check.check,
                          std::isfinite(v.value) ? evidence::text_of(v, check.unit, 3) : "", check.sentence});
  }
  page.table(table);
}

}  // namespace pmg::diagnosis_page
