#pragma once
#include <string>

#include "config/node.hpp"
#include "firmware/hop_session.hpp"

// Lines of hopperd's output: one JSON object each, without a line end. Bytes that are not UTF-8 become
// U+FFFD.
namespace sandhopper {

// With "text" where arming was refused because of a drive, and for a fault: what was seen and what is
// allowed, with the limits of `robot` (robot.toml) where that is given.
std::string operator_text(const Event& event, const ConfigNode* robot = nullptr);
std::string operator_text(const StrideResult& result);
std::string operator_text(const StrengthProfile& profile, const GroundSummary& ground);
std::string operator_text(const GroundEvents& found);
std::string operator_text(const LiveStatus& status);  // {"status":{…}}, keys as in LiveStatus
std::string operator_text(
    const RequestRecord& answer);  // {"request":{…}}, keys as in RequestRecord, and "text"
std::string operator_text(const SessionResult& result);
std::string operator_text(const std::string& key, const std::string& text);

}  // namespace sandhopper
