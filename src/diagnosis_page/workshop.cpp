#include "diagnosis_page/workshop.hpp"

#include <map>

#include "effects/catalogue.hpp"

namespace pmg::diagnosis_page {

namespace {

const std::map<std::string, WorkshopWords>& words() {
  static const std::map<std::string, WorkshopWords> kWords = {
      {"coulomb",
       {"dry friction",
        "Switch the motor off and turn the joint slowly by hand: does it stick? Look at bearings, seals and the "
        "alignment of the shaft.",
        "It stops short of where it should, and small corrections don't move it."}},
      {"viscous",
       {"friction that grows with speed",
        "Switch the motor off and turn the joint by hand, slowly and fast: is fast much harder? Look for thick, cold "
        "or "
        "too much grease.",
        "Fast motion lags behind and warms the motor."}},
      {"stribeck",
       {"friction that is different at very slow motion",
        "Let the joint move very slowly: does it stick and jump? Clean and grease bearings and seals.",
        "Slow motion sticks and jumps: the robot sways where it should stand still."}},
      {"load_friction",
       {"friction that grows with the load",
        "Turn the joint with and without its load: does the load make it harder to turn? Look at the teeth, the grease "
        "and the bearings of the gear.",
        "It stops shorter the more it carries, and lifting takes more current than holding."}},
      {"direction_friction",
       {"friction that is stronger in one direction",
        "Switch the motor off and turn the joint both ways: is one way harder? Look for a tilted bearing, a seal that "
        "rubs, or worn teeth.",
        "It comes nearer to its target from one side than from the other."}},
      {"offset",
       {"a constant torque to one side",
        "Let the joint go where gravity doesn't turn it: does something push it? Look for a cable, a hose or a spring "
        "that pulls.",
        "It rests beside its target, always on the same side."}},
      {"backlash",
       {"play in the gear",
        "Hold the motor still and rock the output by hand: is there a dead spot? Check gear, keys, couplings and "
        "screws.",
        "The limb is loose by this play: it knocks where its load changes sides, and the robot sways within it."}},
      {"compliance",
       {"a soft part between motor and output",
        "Hold the motor still and push the output: does it give way and spring back? Check belt, coupling, gear and "
        "screws.",
        "The limb gives way under load and swings after each stop."}},
      {"delay",
       {"a delay between command and motion",
        "Measure the time from a command to the motion. Check the load of the bus, and filters in the drive.",
        "The robot answers late to a push, and shakes where its gains are high."}},
      {"rate_limit",
       {"a limit on how fast the command may change",
        "Look into the settings of the drive for a limit of speed or acceleration, or for a ramp.",
        "Large fast motions come late: a step that should catch the robot may be too slow."}},
      {"hold",
       {"commands that the drive takes too seldom",
        "Look into the settings of the drive: how often does it take a command?",
        "It moves in small jerks, and shakes where its gains are high."}},
      {"torque_speed",
       {"too little torque at high speed",
        "Measure the supply voltage while the joint moves fast. Check the current limit of the drive, and that the "
        "motor "
        "is of the right type.",
        "Fast motion under load falls short: a step that should catch the robot may be too slow."}},
      {"supply_sag",
       {"a supply voltage that falls under load",
        "Measure the voltage at the drive while the joint works hard. Check power supply, battery, cables and plugs.",
        "It is weakest when the robot needs it most."}},
      {"gain",
       {"a drive that is stronger or weaker than its number says",
        "Compare the gains and their units in the drive with those of the simulation. Check gear ratio and motor "
        "type.",
        "The robot stands stiffer or softer than its controller expects."}},
      {"dead_band",
       {"small errors that the drive ignores",
        "Look into the settings of the drive for a dead band or a smallest output.",
        "It rests a little beside its target and drifts about it."}},
      {"sensor_lag",
       {"a position reading that comes late",
        "Look into the settings of the drive for a filter on the position sensor.",
        "It brakes too late, overshoots and swings."}},
      {"quantisation",
       {"position readings in coarse steps",
        "Check the resolution of the encoder, and how many digits the recording keeps.",
        "The speed that the drive computes is rough: it growls and wears."}},
      {"zero_offset",
       {"a wrong zero of the position sensor",
        "Put the joint on its mark and compare the reading with the angle. Set the zero again.",
        "Whatever uses this angle is wrong by it: a foot stands tilted, or the robot leans."}},
      {"cogging",
       {"a torque that repeats several times per turn",
        "Switch the motor off and turn the joint slowly by hand: do you feel steps? Look at the magnets of the motor "
        "and "
        "the teeth of the gear.",
        "Slow motion is uneven, and places between the steps are hard to hold."}},
      {"hysteresis",
       {"a position sensor that doesn't follow at once when the motion turns",
        "Check that the encoder sits firmly: screws, magnet, coupling.",
        "Where it stands depends on where it came from: the robot never stands twice alike."}},
      {"eccentricity",
       {"a position sensor that isn't centred", "Check that the magnet or disc of the encoder is centred on the shaft.",
        "Its angle is too large at some places and too small at others."}},
      {"thermal_drift",
       {"a joint that changes with its temperature",
        "Record it cold and warm and compare. Check grease, cooling and the temperature of the motor.",
        "Warm, the robot moves otherwise than when it was measured."}},
      {"self_heating",
       {"friction that changes as the joint works",
        "Let the joint work hard for a long time, then turn it by hand and compare with before. Check grease and "
        "cooling.",
        "After hard work it moves otherwise than before."}},
      {"load",
       {"a mass, or the place of a mass, that differs from what is written",
        "Weigh the arm and its load and measure where their centre is. Compare with the numbers of the bench.",
        "The robot computes its balance with a wrong weight: it leans, and swings this limb too far or not far "
        "enough."}},
  };
  return kWords;
}

}  // namespace

WorkshopWords workshop_words(const std::string& effect) {
  const auto found = words().find(effect);
  return found == words().end() ? WorkshopWords{effects::title(effect), "", ""} : found->second;
}

std::string in_workshop_words(const std::vector<std::string>& effects, const std::string& last_joint) {
  std::string text;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    if (i > 0) text += i + 1 == effects.size() ? last_joint : ", ";
    text += workshop_words(effects[i]).what;
  }
  return text;
}

}  // namespace pmg::diagnosis_page
