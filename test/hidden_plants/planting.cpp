#include "planting.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "effect_kinds.hpp"
#include "recorder.hpp"

namespace pmg::hidden {

namespace {

constexpr std::uint64_t kBlock = 20, kSingles = 12, kDoubles = 2, kCleans = 3;

PlantKind kind_of(std::uint64_t seed) {
  const std::uint64_t place = seed % kBlock;
  return place < kSingles                        ? PlantKind::kSingle
         : place < kSingles + kDoubles           ? PlantKind::kDouble
         : place < kSingles + kDoubles + kCleans ? PlantKind::kClean
                                                 : PlantKind::kStrange;
}

/// The count-th of things that take turns, in another order each time round.
const EffectKind& in_turn(std::span<const EffectKind> kinds, std::uint64_t count) {
  std::vector<std::size_t> order(kinds.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  Draw(count / kinds.size(), 77).shuffle(order);
  return kinds[order[count % kinds.size()]];
}

std::vector<const EffectKind*> kinds_of(std::uint64_t seed, PlantKind kind, Draw& draw) {
  const std::uint64_t block = seed / kBlock, place = seed % kBlock;
  if (kind == PlantKind::kClean) return {};
  if (kind == PlantKind::kSingle) return {&in_turn(effect_kinds(), block * kSingles + place)};
  if (kind == PlantKind::kStrange) {
    return {&in_turn(strange_kinds(), block * (kBlock - kSingles - kDoubles - kCleans) + kBlock - 1 - place)};
  }
  const auto on_shaft = [](const EffectKind& one) {
    return one.name == std::string("backlash") || one.name == std::string("compliance");
  };
  const std::span<const EffectKind> kinds = effect_kinds();
  while (true) {
    const EffectKind &a = kinds[draw.below(kinds.size())], &b = kinds[draw.below(kinds.size())];
    const bool apart = a.rig == RigKind::kAny || b.rig == RigKind::kAny || a.rig == b.rig;
    const bool shafts = on_shaft(a) && on_shaft(b);
    if (&a != &b && apart && !shafts) return {&a, &b};
  }
}

/// Each effect draws from its own stream, so that the plant without it has the others as they are.
std::vector<PlantedParameter> plant(const EffectKind& kind, std::uint64_t seed, std::uint64_t stream, Rig& rig,
                                    PlantParameters& p) {
  Draw draw(seed, stream);
  return kind.plants(draw, rig, p);
}

HiddenPlant draw_plant(std::uint64_t seed, std::uint64_t attempt) {
  HiddenPlant hidden;
  hidden.seed = seed;
  hidden.kind = kind_of(seed);
  Draw draw(seed, 1000 * attempt);
  const std::vector<const EffectKind*> kinds = kinds_of(seed, hidden.kind, draw);
  RigKind rig_kind = RigKind::kAny;
  for (const EffectKind* kind : kinds) rig_kind = std::max(rig_kind, kind->rig);
  hidden.rig = draw_rig(draw, rig_kind);
  hidden.plant = hidden.rig.healthy;
  const auto stream = [&](std::size_t i) { return 1000 * attempt + 1 + i; };
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    hidden.effects.push_back(
        {kinds[i]->name, plant(*kinds[i], seed, stream(i), hidden.rig, hidden.plant), PlantParameters{}});
  }
  for (std::size_t without = 0; without < kinds.size(); ++without) {
    PlantParameters& p = hidden.effects[without].plant_without;
    p = hidden.rig.healthy;
    Rig rig = hidden.rig;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      if (i != without) plant(*kinds[i], seed, stream(i), rig, p);
    }
  }
  return hidden;
}

}  // namespace

const char* name(PlantKind kind) {
  switch (kind) {
    case PlantKind::kSingle:
      return "single";
    case PlantKind::kDouble:
      return "double";
    case PlantKind::kClean:
      return "clean";
    case PlantKind::kStrange:
      return "strange";
  }
  return "";
}

std::vector<std::string> planted_effects() {
  std::vector<std::string> names;
  for (const EffectKind& kind : effect_kinds()) names.emplace_back(kind.name);
  return names;
}

std::string effect_in_turn(std::uint64_t count) { return in_turn(effect_kinds(), count).name; }

std::vector<std::string> strange_effects() {
  std::vector<std::string> names;
  for (const EffectKind& kind : strange_kinds()) names.emplace_back(kind.name);
  return names;
}

HiddenPlant hide(std::uint64_t seed) {
  constexpr std::uint64_t kAttempts = 50;
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    HiddenPlant hidden = draw_plant(seed, attempt);
    if (follows_its_commands(hidden)) return hidden;
  }
  throw std::runtime_error("no bench of seed " + std::to_string(seed) + " follows its commands");
}

}  // namespace pmg::hidden
