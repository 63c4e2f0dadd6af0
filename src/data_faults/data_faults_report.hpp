// Data faults for people and machines.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "data_faults/examine.hpp"
#include "pages/page.hpp"
#include "work/worth.hpp"

namespace pmg::data_faults {

/// Of what is computed from these data: off its data, where faults are left in them; open, where they were handled.
work::Worth worth_of(const Examination& examination);

/// Adds `data_faults`, what the diagnosis goes on with, and the thresholds in force.
void add_to(nlohmann::ordered_json& json, const Examination& examination);

/// What the diagnosis goes on with, in one line; "" without faults.
std::string handling_text(const Examination& examination);

/// A few lines, each ending with a newline; "" without faults.
std::string faults_text(const Examination& examination);

/// A line and a table; nothing without faults. The page's worth says which faults there are.
void show_faults(pages::Page& page, const Examination& examination);

}  // namespace pmg::data_faults
