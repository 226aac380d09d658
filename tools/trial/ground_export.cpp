#include "tools/trial/ground_export.hpp"

#include <fmt/format.h>

#include <ostream>

#include "firmware/log/mcap_reader.hpp"
#include "firmware/log/topics.hpp"

namespace sandhopper {
namespace {

void row(std::ostream& out, std::initializer_list<double> values) {
  for (const double value : values) out << fmt::format(",{:.7g}", value);
}

// Cells of one line, separated by commas.
class Line {
 public:
  explicit Line(std::ostream& out) : out_(out) {}
  void add(const std::string& text) {
    out_ << (first_ ? "" : ",") << text;
    first_ = false;
  }

 private:
  std::ostream& out_;
  bool first_ = true;
};

// Expands "line_N_per_m" to "line_N_per_m,line_N_per_m_ci95_low,...".
class Header : public Line {
 public:
  using Line::Line;
  template <class Value>
  void operator()(std::string_view name, const Value&) {
    if constexpr (std::is_same_v<Value, SummaryValue>)
      add(fmt::format("{0},{0}_ci95_low,{0}_ci95_high", name));
    else if constexpr (std::is_same_v<Value, ModelCheck>)
      add(fmt::format("{0}_chi_squared,{0}_chi_squared_limit", name));
    else
      add(std::string(name));
  }
};

class Cells : public Line {
 public:
  using Line::Line;
  template <class Value>
  void operator()(std::string_view, const Value& value) {
    if constexpr (std::is_same_v<Value, SummaryValue>)
      add(fmt::format("{:.7g},{:.7g},{:.7g}", value.value, value.ci95_low, value.ci95_high));
    else if constexpr (std::is_same_v<Value, ModelCheck>)
      add(fmt::format("{:.7g},{:.7g}", value.statistic, value.limit));
    else if constexpr (std::is_same_v<Value, GroundShape>)
      add(std::string(name_of(value)));
    else if constexpr (std::is_same_v<Value, bool>)
      add(value ? "1" : "0");
    else
      add(fmt::format("{:.7g}", static_cast<double>(value)));
  }
};

}  // namespace

GroundRecords ground_records(const std::filesystem::path& log) {
  mcap::Reader reader(log, {.check_crc = false});
  TopicOf<StrengthProfile> profiles{topic::kProfile};
  TopicOf<GroundSummary> summaries{topic::kGround};
  GroundRecords records;
  StrengthProfile profile;
  GroundSummary summary;
  for (mcap::Message message; reader.next(message);) {
    if (profiles.take(message, profile)) records.profiles.push_back(profile);
    if (summaries.take(message, summary)) records.summaries.push_back(summary);
  }
  return records;
}

void write_profile_csv(const std::vector<StrengthProfile>& profiles, std::ostream& out) {
  out << "stride,depth_m,force_N,force_ci95_low_N,force_ci95_high_N,secant_N_per_m,tangent_N_per_m,"
         "tangent_ci95_low_N_per_m,tangent_ci95_high_N_per_m,observations,visited\n";
  for (const auto& p : profiles)
    for (std::size_t i = 0; i < kProfilePoints; ++i) {
      const double depth_m = static_cast<double>(i + 1) * kProfilePoint_m;
      const std::size_t cell = i / 2;  // the cell that ends at this point or contains it
      const ProfilePoint force{p.force_N[i], p.force_sd_N[i]};
      const ProfilePoint tangent{p.tangent_N_per_m[cell], p.tangent_sd_N_per_m[cell]};
      out << p.stride;
      row(out, {depth_m, force.value, force.low(), force.high(), force.value / depth_m, tangent.value,
                tangent.low(), tangent.high(), p.observations[cell]});
      out << (depth_m >= p.depth_min_m && depth_m <= p.depth_max_m ? ",1\n" : ",0\n");
    }
}

void write_ground_csv(const std::vector<GroundSummary>& summaries, std::ostream& out) {
  const GroundSummary none{};
  GroundSummary::fields(none, Header(out));
  out << '\n';
  for (const auto& summary : summaries) {
    GroundSummary::fields(summary, Cells(out));
    out << '\n';
  }
}

}  // namespace sandhopper
