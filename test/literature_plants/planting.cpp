#include "planting.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "forms.hpp"

namespace pmg::literature {

namespace {

/// Of twenty seeds of one parity in a row.
constexpr std::uint64_t kBlock = 20, kAttempts = 50;
struct Share {
  Stratum stratum;
  std::uint64_t count;
};
constexpr Share kStrata[] = {
    {Stratum::kSingle, 5}, {Stratum::kDouble, 5}, {Stratum::kClean, 4}, {Stratum::kStrange, 3}, {Stratum::kFault, 3}};

/// The place of a seed in its block, and how many of its stratum came before it.
struct Turn {
  Stratum stratum = Stratum::kClean;
  std::uint64_t count = 0;
};

Turn turn_of(std::uint64_t seed) {
  const std::uint64_t index = seed / 2, block = index / kBlock;
  std::uint64_t place = index % kBlock;
  for (const auto& [stratum, count] : kStrata) {
    if (place < count) return {stratum, block * count + place};
    place -= count;
  }
  return {};
}

/// The count-th of things that take turns, in another order each time round; even and odd seeds have orders of their
/// own.
std::size_t in_turn(std::size_t size, std::uint64_t count, std::uint64_t seed, std::uint64_t what) {
  std::vector<std::size_t> order(size);
  for (std::size_t i = 0; i < size; ++i) order[i] = i;
  Draw(count / size, 900 + 10 * what + seed % 2).shuffle(order);
  return order[count % size];
}

bool on_shaft(const Form& form) {
  return form.effect == std::string("backlash") || form.effect == std::string("compliance");
}

bool go_together(const Form& a, const Form& b) {
  return a.effect != std::string(b.effect) && !(on_shaft(a) && on_shaft(b)) && both(a.needs, b.needs).laws != 0;
}

std::vector<Form> forms_of(const Turn& turn, std::uint64_t seed, Draw& draw) {
  const std::vector<Form> all = catalogue_forms();
  if (turn.stratum == Stratum::kSingle) return {form_of_single(turn.count, seed % 2)};
  if (turn.stratum == Stratum::kStrange) {
    const std::vector<Form> strange = strange_forms();
    return {strange[in_turn(strange.size(), turn.count, seed, 2)]};
  }
  if (turn.stratum != Stratum::kDouble) return {};
  const Form first = all[in_turn(all.size(), turn.count, seed, 3)];
  while (true) {
    const Form& second = all[draw.below(all.size())];
    if (go_together(first, second)) return {first, second};
  }
}

LiteraturePlant plant_forms(const std::vector<Form>& forms, std::uint64_t seed, std::uint64_t attempt, Draw& draw,
                            const RigNeeds& more = {}) {
  LiteraturePlant plant;
  plant.seed = seed;
  RigNeeds needs = more;
  for (const Form& form : forms) needs = both(needs, form.needs);
  plant.rig = draw_rig(draw, needs);
  const bool sags = std::any_of(forms.begin(), forms.end(),
                                [](const Form& form) { return form.effect == std::string("supply_sag"); });
  if (sags) {  // a recorded bus is an input
    plant.rig.records_bus = false;
    plant.rig.bus_fall = 0.0;
  }
  plant.machine = plant.rig.healthy;
  // Each effect draws from its own stream, so that the machine without it has the others as they are.
  const auto planted = [&](std::size_t i, Machine& machine) {
    Draw own(seed, 1000 * attempt + 1 + i);
    return forms[i].plant(own, plant.rig, machine);
  };
  for (std::size_t i = 0; i < forms.size(); ++i) {
    plant.effects.push_back({forms[i], planted(i, plant.machine), plant.rig.healthy});
  }
  for (std::size_t without = 0; without < forms.size(); ++without) {
    for (std::size_t i = 0; i < forms.size(); ++i) {
      if (i != without) planted(i, plant.effects[without].without);
    }
  }
  return plant;
}

}  // namespace

const char* name(Stratum stratum) {
  switch (stratum) {
    case Stratum::kSingle:
      return "single";
    case Stratum::kDouble:
      return "double";
    case Stratum::kClean:
      return "clean";
    case Stratum::kStrange:
      return "strange";
    case Stratum::kFault:
      return "fault";
  }
  return "";
}

std::vector<Form> catalogue_forms() {
  std::vector<Form> all;
  for (const auto& forms : {friction_forms(), mechanics_forms(), drive_forms(), sensor_forms(), heat_forms()}) {
    all.insert(all.end(), forms.begin(), forms.end());
  }
  return all;
}

bool off_catalogue(const Form& form) {
  const std::vector<Form> all = catalogue_forms();
  return std::ranges::none_of(all, [&](const Form& known) { return known.effect == std::string(form.effect); });
}

bool is_data_fault(const Form& form) { return form.effect == std::string(kFrozenReadings); }

/// Dry friction c (1 + a) one way and c (1 - a) the other is friction c and a constant torque -a c, unless c varies.
/// Torque that fades is a drift, whichever clock it follows. A constant torque that ends with the drive is one while it
/// is on.
std::vector<std::string> same_here(const Form& form, const Machine& m) {
  const Machine::Friction& f = m.friction;
  const bool varies = f.stribeck_Nm != 0.0 || f.load_form != LoadForm::kNone || m.thermal.friction_per_K != 0.0 ||
                      m.thermal.friction_per_Nm2_s != 0.0 || m.thermal.friction_per_J != 0.0;
  const std::string effect = form.effect;
  if (effect == "direction_friction" && f.asymmetry != 0.0 && !varies) return {"offset"};
  const bool steady = effect == "offset" && m.ripple.preload_Nm_per_rad == 0.0;
  if (steady && !varies && std::abs(m.ripple.offset_Nm) < f.coulomb_Nm) return {"direction_friction"};
  if (effect == "self_heating" && (m.thermal.torque_per_Nm2_s != 0.0 || m.thermal.fade_share != 0.0)) {
    return {"thermal_drift"};
  }
  return {};
}

Stratum stratum_of(std::uint64_t seed) { return turn_of(seed).stratum; }

Form form_of_single(std::uint64_t count, std::uint64_t parity) {
  const std::vector<Form> all = catalogue_forms();
  return all[in_turn(all.size(), count, parity, 1)];
}

LiteraturePlant plant_of(std::uint64_t seed) {
  const Turn turn = turn_of(seed);
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    Draw draw(seed, 1000 * attempt);
    const std::vector<Form> forms = forms_of(turn, seed, draw);
    const bool faulty = turn.stratum == Stratum::kFault;
    const std::size_t kind = faulty ? in_turn(std::size(kFaultKinds), turn.count, seed, 4) : 0;
    LiteraturePlant plant = plant_forms(forms, seed, attempt, draw, faulty ? needs_of_fault(kind) : RigNeeds{});
    plant.sound_machine = plant.machine;
    plant.stratum = turn.stratum;
    if (turn.stratum == Stratum::kStrange && !off_catalogue(forms.front())) plant.stratum = Stratum::kSingle;
    if (turn.stratum == Stratum::kStrange && is_data_fault(forms.front())) {
      plant.stratum = Stratum::kFault;
      plant.sound_machine = plant.rig.healthy;
      plant.effects.clear();
      plant.faults.push_back(frozen_readings(plant.rig));
    }
    if (faulty) plant.faults.push_back(draw_fault(draw, kind, plant.rig));
    plant.sound_rig = plant.rig;
    if (faulty) plant.rig = with_fault(plant.faults.front(), plant.sound_rig);
    if (follows_its_commands(plant.machine, plant.rig, seed)) return plant;
  }
  throw std::runtime_error("no bench of seed " + std::to_string(seed) + " follows its commands");
}

LiteraturePlant plant_with(const Form& form, std::uint64_t seed) {
  for (std::uint64_t attempt = 0; attempt < kAttempts; ++attempt) {
    Draw draw(seed, 1000 * attempt);
    LiteraturePlant plant = plant_forms({form}, seed, attempt, draw);
    plant.stratum = Stratum::kSingle;
    plant.sound_rig = plant.rig;
    plant.sound_machine = plant.machine;
    if (follows_its_commands(plant.machine, plant.rig, seed)) return plant;
  }
  throw std::runtime_error(std::string("no bench with ") + form.effect + ", " + form.form + " follows its commands");
}

}  // namespace pmg::literature
