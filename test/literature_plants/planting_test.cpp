// What is planted: strata, forms, data faults, and that each of them shows.
#include "planting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

#include "effects/catalogue.hpp"
#include "folders.hpp"
#include "forms.hpp"
#include "forms_table.hpp"
#include "prepared_plant.hpp"

namespace pmg::literature {
namespace {

TEST(LiteratureForms, EveryEffectOfTheCatalogueHasThreeFormsAndEachFormItsSource) {
  std::map<std::string, std::set<std::string>> forms;
  for (const Form& form : catalogue_forms()) {
    EXPECT_TRUE(forms[form.effect].insert(form.form).second) << form.effect << ": " << form.form << " is there twice";
    EXPECT_FALSE(std::string(form.source).empty());
  }
  for (const effects::Effect& effect : effects::catalogue()) EXPECT_GE(forms[effect.name].size(), 3U) << effect.name;
  EXPECT_EQ(forms.size(), effects::catalogue().size());
  EXPECT_GE(strange_forms().size(), 7U);
}

TEST(LiteratureForms, ThePageHasThemAll) {
  std::ifstream stream(std::filesystem::path(pmg::test::project_folder()) / "docs/explanation/hidden-plants.md");
  const std::string page((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  EXPECT_NE(page.find(forms_table()), std::string::npos) << "print it with: literature_plants forms";
}

/// Mean absolute difference of two machines on the rig, over three of its runs.
double apart_rad(const LiteraturePlant& plant, const Machine& a, const Machine& b) {
  double sum_rad = 0.0;
  for (const std::size_t run : {std::size_t{0}, plant.rig.runs.size() / 2, plant.rig.runs.size() - 1}) {
    sum_rad +=
        mean_absolute_difference_rad(record(a, plant.rig, plant.seed, run), record(b, plant.rig, plant.seed, run));
  }
  return sum_rad / 3.0;
}

/// The same between a recording and its repeat on another day.
double repeat_rad(const LiteraturePlant& plant) {
  double sum_rad = 0.0;
  for (const std::size_t run : {std::size_t{0}, plant.rig.runs.size() / 2, plant.rig.runs.size() - 1}) {
    sum_rad += mean_absolute_difference_rad(record(plant.machine, plant.rig, plant.seed, run),
                                            record(plant.machine, plant.rig, plant.seed, run, 2));
  }
  return sum_rad / 3.0;
}

bool fits(const Form& form, const Rig& rig) {
  const unsigned law = 1U << static_cast<unsigned>(rig.healthy.drive.law);
  return (form.needs.laws & law) != 0 && !(form.needs.weight && rig.horizontal) &&
         !(form.needs.two_loads && rig.loads.size() < 2) && !(form.needs.warm && !rig.records_temperature);
}

struct Shown {
  double from_clean = 0.0, from_siblings = std::numeric_limits<double>::infinity();
};

/// In noise floors of the form's own rig: how far the form is from the healthy joint, and from the nearest other form
/// of its effect with the same draws, so of the same strength where they share numbers.
Shown shown(const Form& form, const std::vector<Form>& siblings, std::uint64_t seed) {
  const LiteraturePlant plant = plant_with(form, seed);
  const double floor_rad = repeat_rad(plant);
  Shown s;
  s.from_clean = apart_rad(plant, plant.machine, plant.rig.healthy) / floor_rad;
  for (const Form& sibling : siblings) {
    if (sibling.effect != std::string(form.effect) || sibling.form == std::string(form.form)) continue;
    if (!fits(sibling, plant.rig)) continue;
    Machine other = plant.rig.healthy;
    Draw draw(seed, 1);
    sibling.plant(draw, plant.rig, other);
    s.from_siblings = std::min(s.from_siblings, apart_rad(plant, plant.machine, other) / floor_rad);
  }
  return s;
}

// A form that doesn't differ from a clean joint by two noise floors, or from its siblings by a quarter of one, would be
// no form of its own: with a thousand samples a run, and noise that is correlated over 0.1 s, a quarter is five
// standard deviations of the mean. Strengths are random, so the best of a few seeds is taken; weak plants don't count
// in a report.
void expect_shown(const std::vector<Form>& all) {
  for (const Form& form : all) {
    Shown best{0.0, 0.0};
    for (std::uint64_t seed = 2; seed <= 20 && !(best.from_clean >= 2.0 && best.from_siblings >= 0.25); seed += 2) {
      const Shown now = shown(form, all, seed);
      best.from_clean = std::max(best.from_clean, now.from_clean);
      // infinite where no sibling can be on that rig
      if (std::isfinite(now.from_siblings)) best.from_siblings = std::max(best.from_siblings, now.from_siblings);
    }
    EXPECT_GE(best.from_clean, 2.0) << form.effect << ": " << form.form;
    EXPECT_GE(best.from_siblings, 0.25) << form.effect << ": " << form.form;
  }
}

TEST(LiteratureForms, EachOfFrictionShowsBesideACleanJointAndBesideItsSiblings) { expect_shown(friction_forms()); }

TEST(LiteratureForms, EachOfMechanicsShowsBesideACleanJointAndBesideItsSiblings) { expect_shown(mechanics_forms()); }

TEST(LiteratureForms, EachOfTheDriveShowsBesideACleanJointAndBesideItsSiblings) { expect_shown(drive_forms()); }

TEST(LiteratureForms, EachOfSensorAndHeatShowsBesideACleanJointAndBesideItsSiblings) {
  expect_shown(sensor_forms());
  expect_shown(heat_forms());
}

TEST(LiteratureForms, WhatIsOffTheCatalogueShows) {
  for (const Form& form : strange_forms()) {
    double best = 0.0;
    for (std::uint64_t seed = 2; seed <= 12 && best < 2.0; seed += 2)
      best = std::max(best, shown(form, {}, seed).from_clean);
    EXPECT_GE(best, 2.0) << form.effect;
  }
}

TEST(LiteraturePlants, TheSameSeedGivesTheSameRecordings) {
  for (const std::uint64_t seed : {0ULL, 12ULL, 26ULL, 32ULL}) {
    const LiteraturePlant a = plant_of(seed), b = plant_of(seed);
    EXPECT_EQ(record(a.machine, a.rig, seed, 0).q_rad, record(b.machine, b.rig, seed, 0).q_rad) << seed;
    EXPECT_NE(record(a.machine, a.rig, seed, 0).q_rad, record(a.machine, a.rig, seed, 0, 1).q_rad) << seed;
  }
}

TEST(LiteraturePlants, TwoMachinesMeetTheSameNoise) {
  const LiteraturePlant plant = plant_of(20);
  Machine one = plant.machine;
  one.sensor.quantum_rad = 0.0;
  Machine other = one;
  other.sensor.offset_rad = 1e-5;
  const double apart_rad = mean_absolute_difference_rad(record(one, plant.rig, 20, 3), record(other, plant.rig, 20, 3));
  EXPECT_GT(apart_rad, 0.0);
  EXPECT_LT(apart_rad, 3e-5);  // a tenth of the least sensor noise: the offset, and rests that it moves
}

TEST(LiteraturePlants, EvenAndOddSeedsHaveTheSameStrata) {
  std::map<Stratum, int> even, odd;
  for (std::uint64_t seed = 0; seed < 600; seed += 2) {
    ++even[stratum_of(seed)];
    ++odd[stratum_of(seed + 1)];
  }
  EXPECT_EQ(even, odd);
  EXPECT_EQ(even[Stratum::kClean], 60);
  EXPECT_EQ(even[Stratum::kDouble], 75);
  EXPECT_EQ(even[Stratum::kFault], 45);
  EXPECT_EQ(even[Stratum::kStrange], 45);
}

TEST(LiteraturePlants, EveryFormHasItsTurnAsTheOnlyEffect) {
  const std::size_t size = catalogue_forms().size();
  for (const std::uint64_t parity : {0ULL, 1ULL}) {
    for (std::uint64_t turn = 0; turn < 3; ++turn) {
      std::set<std::pair<std::string, std::string>> in_turn;
      for (std::uint64_t k = 0; k < size; ++k) {
        const Form form = form_of_single(turn * size + k, parity);
        in_turn.emplace(form.effect, form.form);
      }
      EXPECT_EQ(in_turn.size(), size) << turn;
    }
  }
}

TEST(LiteraturePlants, WarmBenchesAreAsOftenWithoutConsequence) {
  int warm_and_drifting = 0, warm_only = 0;
  for (std::uint64_t seed = 0; seed < 240; seed += 2) {
    const Stratum stratum = stratum_of(seed);
    if (stratum == Stratum::kDouble) continue;  // costs time, says nothing more
    const LiteraturePlant plant = plant_of(seed);
    if (plant.rig.warms_K < 25.0 || !plant.rig.records_temperature) continue;
    const bool drifts = !plant.effects.empty() && plant.effects.front().form.effect == std::string("thermal_drift");
    ++(drifts ? warm_and_drifting : warm_only);
  }
  EXPECT_GT(warm_only, 10);
  EXPECT_GE(warm_only, warm_and_drifting);
}

TEST(LiteraturePlants, EveryKindOfFaultTakesItsTurn) {
  std::set<std::string> kinds;
  for (std::uint64_t seed = 0; seed < 120; seed += 2) {
    if (stratum_of(seed) != Stratum::kFault) continue;
    const LiteraturePlant plant = plant_of(seed);
    ASSERT_EQ(plant.faults.size(), 1U);
    EXPECT_TRUE(plant.effects.empty());
    EXPECT_FALSE(plant.faults.front().runs.empty());
    kinds.insert(plant.faults.front().kind);
  }
  EXPECT_EQ(kinds, std::set<std::string>(std::begin(kFaultKinds), std::end(kFaultKinds)));
}

TEST(LiteraturePlants, ReadingsThatFreezeTakeTheirTurnOffTheCatalogueAndAreADataFault) {
  constexpr std::uint64_t kSeed = 270;
  ASSERT_EQ(stratum_of(kSeed), Stratum::kStrange);
  const LiteraturePlant plant = plant_of(kSeed);
  EXPECT_EQ(plant.stratum, Stratum::kFault);
  EXPECT_TRUE(plant.effects.empty());
  ASSERT_EQ(plant.faults.size(), 1U);
  EXPECT_EQ(plant.faults.front().kind, kFrozenReadings);
  EXPECT_EQ(plant.faults.front().runs.size(), plant.rig.runs.size());
  const Recording sound = record(plant.sound_machine, plant.rig, kSeed, 0),
                  lost = record(plant.machine, plant.rig, kSeed, 0);
  std::size_t repeats = 0, later = 0;
  for (std::size_t k = 1; k < lost.q_rad.size(); ++k) {
    if (lost.q_rad[k] == sound.q_rad[k]) continue;
    ++(lost.q_rad[k] == lost.q_rad[k - 1] ? repeats : later);
  }
  EXPECT_GT(repeats, lost.q_rad.size() / 10);
  EXPECT_EQ(later, 0U) << "what isn't lost is the joint's";
}

std::vector<FiledRun> files_of(const Rig& rig, std::uint64_t seed) {
  std::vector<FiledRun> files;
  for (std::size_t i = 0; i < rig.runs.size(); ++i) {
    files.push_back({i, rig.gains[rig.runs[i].gains], rig.loads[rig.runs[i].load], record(rig.healthy, rig, seed, i)});
  }
  return files;
}

TEST(DataFaults, ChangeNothingButWhatTheySay) {
  for (std::size_t kind = 0; kind < std::size(kFaultKinds); ++kind) {
    Draw draw(6, kind);
    Rig rig = draw_rig(draw, needs_of_fault(kind));
    const DataFault fault = draw_fault(draw, kind, rig);
    const std::vector<FiledRun> before = files_of(rig, 6);
    std::vector<FiledRun> after = kind == 3 ? files_of(with_fault(fault, rig), 6) : before;
    spoil(fault, after);
    for (std::size_t i = 0; i < before.size(); ++i) {
      const bool meant = std::find(fault.runs.begin(), fault.runs.end(), i) != fault.runs.end();
      const bool same = before[i].recording.q_rad == after[i].recording.q_rad &&
                        before[i].recording.q_cmd_rad == after[i].recording.q_cmd_rad &&
                        before[i].recording.feed_forward == after[i].recording.feed_forward &&
                        before[i].gains.kp == after[i].gains.kp;
      EXPECT_EQ(same, !meant) << fault.kind << ", run " << i;
      EXPECT_EQ(before[i].load.mass_kg, after[i].load.mass_kg) << fault.kind;  // the row says what it said
    }
  }
}

TEST(DataFaults, AColumnComesLaterByItsShift) {
  Draw draw(8, 1);
  Rig rig = draw_rig(draw, {});
  const std::vector<FiledRun> before = files_of(rig, 8);
  std::vector<FiledRun> after = before;
  DataFault fault;
  fault.kind = "time_shift";
  fault.column = "q_rad";
  fault.runs = {2};
  fault.shift = 3;
  spoil(fault, after);
  EXPECT_EQ(after[2].recording.q_rad[100], before[2].recording.q_rad[97]);
  EXPECT_EQ(after[2].recording.q_rad.front(), before[2].recording.q_rad.front());
  EXPECT_EQ(after[2].recording.q_cmd_rad, before[2].recording.q_cmd_rad);
}

}  // namespace
}  // namespace pmg::literature
