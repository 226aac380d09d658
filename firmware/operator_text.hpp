#pragma once
#include <string>

#include "firmware/hop_session.hpp"

// Lines of hopperd's output: one JSON object each, without a line end. Bytes that are not UTF-8 become
// U+FFFD.
namespace sandhopper {

std::string operator_text(const Event& event);  // has "text" if arming was refused because of a drive
std::string operator_text(const StrideResult& result);
std::string operator_text(const StrengthProfile& profile, const GroundSummary& ground);
std::string operator_text(const GroundEvents& found);
std::string operator_text(const LiveStatus& status);  // {"status":{…}}, keys as in LiveStatus
std::string operator_text(
    const RequestRecord& answer);  // {"request":{…}}, keys as in RequestRecord, and "text"
std::string operator_text(const SessionResult& result);
std::string operator_text(const std::string& key, const std::string& text);

}  // namespace sandhopper
