#include "tools/conceal/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "tools/conceal/visibility.hpp"

namespace sandhopper::conceal {
namespace {

constexpr Kind kKinds[] = {Kind::null,    Kind::decoy,   Kind::single,
                           Kind::several, Kind::unknown, Kind::indistinguishable};
constexpr const char* kNames[] = {"null", "decoy", "single", "several", "unknown", "indistinguishable"};
constexpr int kInSixteen[] = {3, 1, 6, 2, 2, 2};

struct Range {
  double low, high;
};
// Range of the sizes relative to typical.
Range sizes(Kind kind) {
  switch (kind) {
    case Kind::several:
      return {0.5, 2.0};
    case Kind::unknown:
      return {0.5, 3.0};
    case Kind::indistinguishable:
      return {0.5, 1.5};
    default:
      return {0.1, 3.0};
  }
}

constexpr double kActs = 0.02;  // An effect with less visibility does nothing on this apparatus.
constexpr int kAttempts = 200;

// Sixteen consecutive campaigns contain every kind in its share, in an order drawn from the seed.
Kind kind_of(const Request& request, std::uint64_t index) {
  std::vector<Kind> deck;
  for (std::size_t i = 0; i < std::size(kKinds); ++i)
    for (int n = 0; n < kInSixteen[i]; ++n) deck.push_back(kKinds[i]);
  auto random = Random(request.seed).stream("kinds", index / deck.size());
  for (std::size_t i = deck.size() - 1; i > 0; --i)
    std::swap(deck[i], deck[static_cast<std::size_t>(random.below(static_cast<int>(i) + 1))]);
  return deck[index % deck.size()];
}

template <class T>
const T& pick(const std::vector<T>& all, Random& random) {
  return all.at(static_cast<std::size_t>(random.below(static_cast<int>(all.size()))));
}

const EffectInfo* named(const std::vector<EffectInfo>& all, const std::string& id) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const EffectInfo& e) { return e.id == id; });
  return found == all.end() ? nullptr : &*found;
}

// Draws the effects to hide, and sets the restriction or the port that belongs to them.
std::vector<EffectInfo> draw_effects(Case& c, const Request& request, Random& random) {
  const auto listed = c.plant->listed(), unlisted = c.plant->unlisted();
  if (c.kind == Kind::null || c.kind == Kind::decoy) {
    // Some null campaigns have the limited apparatus of the ambiguous ones, so that it gives no hint.
    if (const auto count = c.plant->ambiguities().size(); count > 0 && random.chance(0.35))
      c.restriction = static_cast<std::size_t>(random.below(static_cast<int>(count)));
    return {};
  }
  if (c.kind == Kind::unknown) {
    const auto* asked = named(unlisted, request.effect);
    const auto one = asked ? *asked : pick(unlisted, random);
    c.unknown_port = one.port;
    return {one};
  }
  if (c.kind == Kind::indistinguishable) {
    const auto ambiguities = c.plant->ambiguities();
    c.restriction = static_cast<std::size_t>(random.below(static_cast<int>(ambiguities.size())));
    c.ambiguity = ambiguities[*c.restriction].ids;
    return {*named(listed, c.ambiguity.front())};
  }
  const auto* asked = named(listed, request.effect);
  std::vector<EffectInfo> chosen{asked ? *asked : pick(listed, random)};
  const std::size_t count = c.kind == Kind::single ? 1 : random.chance(0.7) ? 2 : 3;
  while (chosen.size() < count) {
    const auto one = pick(listed, random);
    const auto same = [&](const EffectInfo& e) { return e.group == one.group; };
    if (std::none_of(chosen.begin(), chosen.end(), same)) chosen.push_back(one);
  }
  return chosen;
}

// Draws defects of the recording that have nothing to do with physics.
void draw_wear(Case& c, Random& random) {
  const double more = c.kind == Kind::decoy ? 3.0 : 1.0;
  const auto expendable = c.plant->expendable();
  const bool dead = random.chance(0.12 * more);
  if (!expendable.empty()) {
    const auto channel = pick(expendable, random);
    if (dead) c.dead_channel = channel;
  }
  c.gaps = random.chance(0.2 * more);
  c.foreign_names = random.chance(0.25 * more);
}

const Plant& plant_for(const Request& request, Random& random) {
  if (!request.plant.empty()) {
    if (const auto* plant = find_plant(request.plant)) return *plant;
    throw std::invalid_argument(fmt::format("there is no plant '{}'", request.plant));
  }
  std::vector<const Plant*> able;
  for (const auto* plant : plants())
    if (request.effect.empty() || named(plant->listed(), request.effect) ||
        named(plant->unlisted(), request.effect))
      able.push_back(plant);
  if (able.empty()) throw std::invalid_argument(fmt::format("no plant has an effect '{}'", request.effect));
  return *pick(able, random);
}

Case attempt(const Request& request, std::uint64_t index, const Random& base, int number) {
  const auto random = base.stream("attempt", static_cast<std::uint64_t>(number));
  // Independent of the attempt, so that no plant or kind becomes rare because its effects are hard to see.
  auto which = base.stream("which");
  Case c;
  c.plant = &plant_for(request, which);
  const bool outside = !request.effect.empty() && named(c.plant->unlisted(), request.effect);
  const Kind drawn = kind_of(request, index);
  c.kind = request.kind             ? *request.kind
           : request.effect.empty() ? drawn
           : outside                ? Kind::unknown
                                    : Kind::single;
  c.apparatus = random.stream("apparatus");
  c.recording = random.stream("recording");
  auto choice = random.stream("choice");
  const auto effects = draw_effects(c, request, choice);
  auto wear = random.stream("wear");
  draw_wear(c, wear);
  const auto range = sizes(c.kind);
  auto magnitude = base.stream("size");
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const double size = magnitude.log_uniform(range.low, range.high);
    c.hidden.push_back({effects[i], request.size.value_or(size), random.stream("hide", i)});
  }
  c.setups = build(c, {})->draw_setups(request.trials, random.stream("setups"));
  return c;
}

// True if the effect can act on this apparatus: at typical size it moves some channel clearly, at its own
// size at least a little.
bool acts(const Case& c, const HiddenEffect& effect) {
  auto typical = effect;
  typical.size = std::max(effect.size, 1.0);
  return visibility(c, {typical}).ratio > kActs &&
         (effect.size >= 1.0 || visibility(c, {effect}).ratio > 0.0);
}

// True if the effect is visible beside the other hidden effects. A saturated sensor, for example, would hide
// it.
bool acts_beside(const Case& c, std::size_t which) {
  auto others = c.hidden;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(which));
  return others.empty() || difference(c, c.hidden, others).ratio > kActs;
}

bool all_act(const Case& c) {
  for (std::size_t i = 0; i < c.hidden.size(); ++i)
    if (!acts(c, c.hidden[i]) || !acts_beside(c, i)) return false;
  return true;
}

}  // namespace

void check(const Request& request) {
  auto random = Random(request.seed);
  const auto& plant = plant_for(request, random);
  if (request.effect.empty()) return;
  if (!named(plant.listed(), request.effect) && !named(plant.unlisted(), request.effect))
    throw std::invalid_argument(fmt::format("the plant {} has no effect '{}'", plant.name(), request.effect));
}

const char* name_of(Kind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::optional<Kind> kind_named(const std::string& name) {
  for (std::size_t i = 0; i < std::size(kKinds); ++i)
    if (name == kNames[i]) return kKinds[i];
  return std::nullopt;
}

Json Request::to_json() const {
  Json json{{"seed", seed}, {"plant", plant}, {"effect", effect}, {"trials", trials}};
  json["kind"] = kind ? Json(name_of(*kind)) : Json();
  json["size"] = size ? Json(*size) : Json();
  return json;
}

Request Request::from_json(const Json& json) {
  Request r;
  r.seed = json.at("seed").get<std::uint64_t>();
  r.plant = json.at("plant").get<std::string>();
  r.effect = json.at("effect").get<std::string>();
  r.trials = json.at("trials").get<int>();
  if (!json.at("kind").is_null()) r.kind = kind_named(json.at("kind").get<std::string>());
  if (!json.at("size").is_null()) r.size = json.at("size").get<double>();
  return r;
}

Case make_case(const Request& request, std::uint64_t index) {
  check(request);
  const auto base = Random(request.seed).stream("case", index);
  for (int i = 0; i < kAttempts; ++i) {
    auto c = attempt(request, index, base, i);
    if (!all_act(c)) continue;
    c.bench = c.plant->build(c.apparatus);
    if (c.restriction) c.bench->restrict_to(*c.restriction);
    for (auto& effect : c.hidden) {
      auto parameters = c.bench->hide(effect.info.id, effect.size, effect.random);
      c.effects.push_back(
          {{"id", effect.info.id}, {"parameters", parameters}, {"size_relative", effect.size}});
    }
    return c;
  }
  throw std::invalid_argument(
      fmt::format("case {}: the effect asked for does nothing on any apparatus drawn", index));
}

std::unique_ptr<Bench> build(const Case& c, const std::vector<HiddenEffect>& hidden) {
  auto bench = c.plant->build(c.apparatus);
  if (c.restriction) bench->restrict_to(*c.restriction);
  for (const auto& effect : hidden) bench->hide(effect.info.id, effect.size, effect.random);
  return bench;
}

Table record(const Case& c, const Bench& bench, const Setup& setup, const TrialRandom& trial) {
  auto table = bench.record(setup, trial);
  if (auto* dead = table.find(c.dead_channel))
    std::fill(dead->values.begin(), dead->values.end(), std::numeric_limits<double>::quiet_NaN());
  auto random = trial.stream("gap");
  const double length = random.uniform(0.005, 0.02), place = random.uniform(0.05, 0.9);
  if (!random.chance(0.4) || !c.gaps || table.rows() < 2) return table;
  const auto& t_s = table.columns.front().values;
  std::vector<bool> kept(t_s.size());
  const double from_s = place * t_s.back();
  for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = t_s[i] < from_s || t_s[i] > from_s + length;
  table.keep_rows(kept);
  return table;
}

}  // namespace sandhopper::conceal
