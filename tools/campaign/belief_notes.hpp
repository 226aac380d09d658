#pragma once
#include <span>
#include <string_view>

#include "tools/campaign/plant_kind.hpp"

namespace sandhopper {

// Reason for the default of a key of nominal.toml. `path`: "table.key".
std::string_view reason_of_default(std::string_view path);

// True if the plant needs the number and its default is only a placeholder.
bool is_needed(std::string_view path);

// True if `hop campaign import` asks for the key: it decides the answer of this plant.
bool decides_answer(CampaignPlant plant, std::string_view path);

// Keys of another laboratory's hopper that decide its answer: dimensions, masses and inertias of the leg, the
// drives' constant, the length at which the leg is released. Their defaults are this project's robot.
std::span<const std::string_view> hopper_keys();

// The same for its controller; needed if no channel holds the commanded torques.
std::span<const std::string_view> hopper_controller_keys();

}  // namespace sandhopper
