#pragma once
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sandhopper {

// Data in front of a log's records: configuration and other texts as attachments, build and board as
// metadata. A freeze frame of the same trial has the same.
struct LogDescription {
  struct Attachment {
    std::string name;
    std::string media_type;
    std::string text;
  };
  std::vector<Attachment> attachments{};
  std::vector<std::pair<std::string, std::map<std::string, std::string>>> metadata{};
};

}  // namespace sandhopper
