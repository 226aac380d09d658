#pragma once
#include <string>
#include <string_view>

namespace sandhopper {

// A line of [columns] with the unit of the column, or with the scale alone if it turns the sign. `unit` and
// `scale` together mean that the user confirms the values, which switches the checks off.
std::string draft_mapping(std::string_view channel, const std::string& column, std::string_view unit,
                          double scale, double offset = 0.0, const std::string& plus = "");

// The line of a torque whose column is a current: it asks for the torque constant.
std::string draft_torque(const std::string& column, const std::string& unit);

}  // namespace sandhopper
