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
        "alignment of the shaft."}},
      {"viscous",
       {"friction that grows with speed",
        "Switch the motor off and turn the joint by hand, slowly and fast: is fast much harder? Look for thick, cold "
        "or "
        "too much grease."}},
      {"stribeck",
       {"friction that is different at very slow motion",
        "Let the joint move very slowly: does it stick and jump? Clean and grease bearings and seals."}},
      {"load_friction",
       {"friction that grows with the load",
        "Turn the joint with and without its load: does the load make it harder to turn? Look at the teeth, the grease "
        "and the bearings of the gear."}},
      {"direction_friction",
       {"friction that is stronger in one direction",
        "Switch the motor off and turn the joint both ways: is one way harder? Look for a tilted bearing, a seal that "
        "rubs, or worn teeth."}},
      {"offset",
       {"a constant torque to one side",
        "Let the joint go where gravity doesn't turn it: does something push it? Look for a cable, a hose or a spring "
        "that pulls."}},
      {"backlash",
       {"play in the gear",
        "Hold the motor still and rock the output by hand: is there a dead spot? Check gear, keys, couplings and "
        "screws."}},
      {"compliance",
       {"a soft part between motor and output",
        "Hold the motor still and push the output: does it give way and spring back? Check belt, coupling, gear and "
        "screws."}},
      {"delay",
       {"a delay between command and motion",
        "Measure the time from a command to the motion. Check the load of the bus, and filters in the drive."}},
      {"rate_limit",
       {"a limit on how fast the command may change",
        "Look into the settings of the drive for a limit of speed or acceleration, or for a ramp."}},
      {"hold",
       {"commands that the drive takes too seldom",
        "Look into the settings of the drive: how often does it take a command?"}},
      {"torque_speed",
       {"too little torque at high speed",
        "Measure the supply voltage while the joint moves fast. Check the current limit of the drive, and that the "
        "motor "
        "is of the right type."}},
      {"supply_sag",
       {"a supply voltage that falls under load",
        "Measure the voltage at the drive while the joint works hard. Check power supply, battery, cables and plugs."}},
      {"gain",
       {"a drive that is stronger or weaker than its number says",
        "Compare the gains and their units in the drive with those of the simulation. Check gear ratio and motor "
        "type."}},
      {"dead_band",
       {"small errors that the drive ignores",
        "Look into the settings of the drive for a dead band or a smallest output."}},
      {"sensor_lag",
       {"a position reading that comes late",
        "Look into the settings of the drive for a filter on the position sensor."}},
      {"quantisation",
       {"position readings in coarse steps",
        "Check the resolution of the encoder, and how many digits the recording keeps."}},
      {"zero_offset",
       {"a wrong zero of the position sensor",
        "Put the joint on its mark and compare the reading with the angle. Set the zero again."}},
      {"cogging",
       {"a torque that repeats several times per turn",
        "Switch the motor off and turn the joint slowly by hand: do you feel steps? Look at the magnets of the motor "
        "and "
        "the teeth of the gear."}},
      {"hysteresis",
       {"a position sensor that doesn't follow at once when the motion turns",
        "Check that the encoder sits firmly: screws, magnet, coupling."}},
      {"eccentricity",
       {"a position sensor that isn't centred",
        "Check that the magnet or disc of the encoder is centred on the shaft."}},
      {"thermal_drift",
       {"a joint that changes with its temperature",
        "Record it cold and warm and compare. Check grease, cooling and the temperature of the motor."}},
      {"self_heating",
       {"friction that changes as the joint works",
        "Let the joint work hard for a long time, then turn it by hand and compare with before. Check grease and "
        "cooling."}},
      {"load",
       {"a mass, or the place of a mass, that differs from what is written",
        "Weigh the arm and its load and measure where their centre is. Compare with the numbers of the bench."}},
  };
  return kWords;
}

}  // namespace

WorkshopWords workshop_words(const std::string& effect) {
  const auto found = words().find(effect);
  return found == words().end() ? WorkshopWords{effects::title(effect), ""} : found->second;
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
