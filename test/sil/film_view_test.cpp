// Where a film's camera stands: whoever watches sees the motion that the caption names.
#include "sil/film_view.hpp"

#include <gtest/gtest.h>

#include "sil/scenario.hpp"

namespace pmg::sil {
namespace {

TEST(FilmView, TheTourShowsWalkingAheadFromTheSideAndLeaningFromTheFront) {
  const Scenario tour = load_scenario("config/scenarios/tour.yaml");
  const auto side = [&tour](const std::string& text) {
    for (const ScenarioStep& step : tour.steps) {
      if (step.text == text) return shown_from_deg(step.command);
    }
    ADD_FAILURE() << "no step " << text;
    return std::optional<double>();
  };
  for (const char* text :
       {"squat", "bend forward", "walk forward 0.6 m/s", "walk backward 0.4 m/s", "walk crouched", "walk bent forward"})
    EXPECT_EQ(side(text), kFromTheLeft_deg) << text;
  for (const char* text : {"lean to the right", "lean to the left", "sidestep to the left", "walk leaning to the left"})
    EXPECT_EQ(side(text), kFromTheFront_deg) << text;
  for (const char* text : {"turn to the left", "circle", "walk diagonally", "turn crouched", "all six at once"})
    EXPECT_EQ(side(text), kFromTheFrontAndLeft_deg) << text;
  EXPECT_EQ(side("stand"), std::nullopt) << "it looks on from where it is";
}

}  // namespace
}  // namespace pmg::sil
