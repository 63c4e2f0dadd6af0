#include "diagnosis_page/first_paragraph.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "diagnosis_page/amount.hpp"
#include "diagnosis_page/assemblies.hpp"
#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {

namespace {

using diagnosis::Cause;
using diagnosis::Diagnosis;

std::string recordings(int count) { return fmt::format("{} recording{}", count, count == 1 ? "" : "s"); }

/// "a, b or c" with ", " between and " or " before the last.
std::string listed(const std::vector<std::string>& texts, const char* between, const char* before_last) {
  std::string text;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (i > 0) text += i + 1 == texts.size() ? before_last : between;
    text += texts[i];
  }
  return text;
}

/// Of its form where the recordings tell it, else of the effect.
effects::WorkshopWords words_of(const Cause& cause) {
  return effects::workshop_words(cause.effect, cause.form_or_instead.empty() ? cause.form : "");
}

/// The cause with its size, and every name that it may have as well.
std::string with_other_names(const bench::Bench& bench, const Diagnosis& diagnosis, const Cause& cause) {
  std::vector<std::string> names{words_of(cause).what};
  if (const std::string size = amount(bench, diagnosis, cause); !size.empty()) names[0] += " (" + size + ")";
  for (const std::string& other : cause.or_instead) names.push_back(effects::workshop_words(other).what);
  for (const std::string& other : cause.same_here) names.push_back(effects::workshop_words(other).what);
  return listed(names, ", ", " or ");
}

/// The causes that may be another effect, or those that may not.
std::string causes_text(const bench::Bench& bench, const Diagnosis& diagnosis, bool open) {
  std::vector<std::string> texts;
  for (const Cause& cause : diagnosis.causes) {
    if (cause.or_instead.empty() != open) texts.push_back(with_other_names(bench, diagnosis, cause));
  }
  return listed(texts, "; ", "; and ");
}

bool some(const Diagnosis& diagnosis, std::vector<std::string> Cause::*names) {
  return std::any_of(diagnosis.causes.begin(), diagnosis.causes.end(),
                     [&](const Cause& cause) { return !(cause.*names).empty(); });
}

std::string plain(const std::string& circumstance) {
  static const std::map<std::string, std::string> kPlain = {
      {"velocity", "the speed"},
      {"position", "the position"},
      {"load", "the torque of the load"},
      {"drive", "how hard the motor works"},
      {"temperature", "the temperature"},
      {"time since the command changed", "the time since the command changed"},
      {"time", "the time since the recording began"}};
  const auto found = kPlain.find(circumstance);
  return found == kPlain.end() ? circumstance : found->second;
}

std::string on_what(const Diagnosis& diagnosis) {
  std::vector<std::string> names;
  for (const std::string& name : diagnosis.depends_on) names.push_back(plain(name));
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The causes; which of them are sure, and which open.
std::string has(const bench::Bench& bench, const Diagnosis& diagnosis) {
  const std::string sure = causes_text(bench, diagnosis, false), open = causes_text(bench, diagnosis, true);
  if (open.empty()) return fmt::format("This joint has {}.", sure);
  return fmt::format("{}Open: it has {}. Where it says \"or\", these recordings don't tell which.",
                     sure.empty() ? "" : fmt::format("Sure: this joint has {}. ", sure), open);
}

std::string what_every_assembly_has(const bench::Bench& bench, const Diagnosis& diagnosis) {
  switch (diagnosis.verdict) {
    case evidence::Verdict::kNone:
      return "We found nothing in this joint that its simulation doesn't have already.";
    case evidence::Verdict::kFound:
    case evidence::Verdict::kAmbiguous:
      if (diagnosis.causes.empty()) return "Its simulation is right on average over the assemblies of this joint.";
      return has(bench, diagnosis) + " Its simulation did not have this, or not in the right size.";
    case evidence::Verdict::kUnexplained:
    case evidence::Verdict::kInterrupted:
      break;
  }
  std::string text = "This joint does something that its simulation doesn't do, and no effect on our list explains it.";
  if (!diagnosis.depends_on.empty()) text += fmt::format(" It changes with {}.", on_what(diagnosis));
  if (!diagnosis.causes.empty()) text += " Besides: " + has(bench, diagnosis);
  return text;
}

std::string what_is_wrong(const bench::Bench& bench, const Diagnosis& diagnosis) {
  const std::string differences = differences_in_words(diagnosis);
  return what_every_assembly_has(bench, diagnosis) + (differences.empty() ? "" : " " + differences);
}

std::string how_sure(const Diagnosis& diagnosis) {
  std::string text;
  switch (diagnosis.verdict) {
    case evidence::Verdict::kFound:
      text = " We are fairly sure: no other effect on our list explains the recordings as well.";
      break;
    case evidence::Verdict::kNone:
      text = " We are fairly sure of what these recordings can show; \"Not ruled out\" lists what we can't say.";
      break;
    case evidence::Verdict::kUnexplained:
      text = " We are sure that something is there: it is clearly larger than the noise of the recordings.";
      break;
    case evidence::Verdict::kAmbiguous:
    case evidence::Verdict::kInterrupted:
      break;
  }
  if (some(diagnosis, &Cause::same_here) && diagnosis.verdict != evidence::Verdict::kAmbiguous)
    text += " On this test rig the names with \"or\" mean the same; the simulation is right with either.";
  return text;
}

/// Of the two strongest causes; a third one hardly matters beside them.
std::string what_it_costs(const Diagnosis& diagnosis) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, diagnosis.causes.size()); ++i) {
    const std::string cost = words_of(diagnosis.causes[i]).cost;
    if (!cost.empty()) text += (text.empty() ? "" : " ") + cost;
  }
  return text.empty() ? "" : "On the robot: " + text + " ";
}

std::string how_much_better(const bench::Bench& bench, const Diagnosis& diagnosis) {
  const double before = diagnosis.held_out_before.value, after = diagnosis.held_out_after.value;
  const std::string runs = diagnosis.held_out ? " on recordings that we kept aside for this test" : "";
  const std::string noise =
      diagnosis.noise_floor.mean_absolute_rad > 0.0
          ? fmt::format("; noise alone makes {}", size(bench, diagnosis.noise_floor.mean_absolute_rad))
          : "";
  if (diagnosis.causes.empty() && diagnosis.assemblies.varies.empty())
    return fmt::format("On average the simulation misses the measured position by {}{}{}.", size(bench, after), runs,
                       noise);
  if (after < before)
    return fmt::format(
        "With it the simulation gets better: on average it missed the measured position by {}, now by "
        "{}{}{}.",
        size(bench, before), size(bench, after), runs, noise);
  return fmt::format(
      "But with it the simulation gets no better: on average it missed the measured position by {}, now "
      "by {}{}{}. So don't rely on it.",
      size(bench, before), size(bench, after), runs, noise);
}

bool contradict_each_other(const Diagnosis& diagnosis) {
  const std::vector<bench::OddRun>& odd = diagnosis.noise_floor.odd_runs;
  return std::any_of(odd.begin(), odd.end(),
                     [](const bench::OddRun& one) { return !one.left_out && one.deviation_rad > 0.0; });
}

std::string record_next(const diagnosis::NextExcitation& next) {
  int count = 0;
  for (const diagnosis::NextRun& run : next.runs) count += run.times;
  return fmt::format("make the {} that \"What to record next\" shows, and start the diagnosis again",
                     recordings(count));
}

std::string what_next(const Diagnosis& diagnosis) {
  const bool more = diagnosis.next_excitation && !diagnosis.next_excitation->runs.empty();
  if (diagnosis.verdict == evidence::Verdict::kAmbiguous && more)
    return fmt::format("To settle it, {}.", record_next(*diagnosis.next_excitation));
  if (diagnosis.verdict == evidence::Verdict::kNone)
    return fmt::format("Next: at the joint there is nothing{} to do.",
                       diagnosis.data.readings_left_out.empty() ? "" : " else");
  if (!diagnosis.causes.empty()) {
    std::string text = fmt::format("Next: {}", words_of(diagnosis.causes.front()).check);
    if (diagnosis.causes.size() > 1) text += " \"What to check\" has the rest.";
    return text;
  }
  if (!diagnosis.assemblies.varies.empty()) return fmt::format("Next: {}", check_of_differences(diagnosis));
  if (contradict_each_other(diagnosis))
    return "Some recordings of the same motion contradict each other: that alone may be the reason. Next: look at the "
           "odd "
           "runs that are named below, and record them again.";
  return "Next: look at the pictures of the recordings that fit worst, and check what the list doesn't know: loose "
         "screws, a table that shakes, a cable that pulls, something that rubs.";
}

/// What was wrong with the recordings, where the rest was computed all the same; a space at its end.
std::string on_the_recordings(const data_faults::Examination& data) {
  std::string text;
  if (!data.corrected.empty())
    text =
        "The recordings have faults: mend them as it says above. All that follows was computed from corrected "
        "recordings. ";
  if (!data.readings_left_out.empty())
    text +=
        "The position reading stood still again and again while the joint moved: check what else is on its bus, "
        "its plugs and its cable. These readings were left out. ";
  return text;
}

}  // namespace

std::string first_paragraph(const bench::Bench& bench, const Diagnosis& diagnosis) {
  if (diagnosis.data.uncorrected())
    return "The recordings have faults: they stand above. All that follows was computed from the faulty recordings: "
           "don't "
           "trust it. Next: repair the recordings, or start the diagnosis again with the corrections, and read its new "
           "page.";
  if (diagnosis.verdict == evidence::Verdict::kInterrupted)
    return "The diagnosis was stopped before it was finished: it doesn't say what is wrong with this joint, nor that "
           "nothing "
           "is. Next: start it again, and let it end.";
  if (worth_of(diagnosis).grade() == work::Grade::kOffItsData)
    return "The simulation doesn't move as this joint does, not even roughly: the recordings may be of something else. "
           "Next: "
           "look at the pictures, and check which joint was recorded, its commands and its readings.";
  return fmt::format("{}{}{} {}{} {}", on_the_recordings(diagnosis.data), what_is_wrong(bench, diagnosis),
                     how_sure(diagnosis), what_it_costs(diagnosis), how_much_better(bench, diagnosis),
                     what_next(diagnosis));
}

void show_what_to_check(pages::Page& page, const Diagnosis& diagnosis) {
  if (diagnosis.causes.empty()) return;
  page.heading("What to check");
  pages::Table table{.header = {"what it may be", "name in the tables below", "check this"}, .rows = {}};
  std::set<std::string> listed;
  const auto add = [&](const std::string& effect, const effects::WorkshopWords& words) {
    if (listed.insert(effect).second) table.rows.push_back({words.what, effects::title(effect), words.check});
  };
  for (const Cause& cause : diagnosis.causes) {
    add(cause.effect, words_of(cause));
    for (const std::string& other : cause.or_instead) add(other, effects::workshop_words(other));
    for (const std::string& other : cause.same_here) add(other, effects::workshop_words(other));
  }
  page.table(table);
}

}  // namespace pmg::diagnosis_page
