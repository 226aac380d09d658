#include "tools/diagnose/recordings/given_effects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/hint.hpp"
#include "config/load.hpp"
#include "tools/diagnose/model/effect.hpp"
#include "tools/diagnose/model/parameter_names.hpp"
#include "tools/diagnose/recordings/campaign_input.hpp"

namespace sandhopper::diagnose {
namespace {

using Names = std::vector<std::string>;

// A campaign of the plant in which every effect of its list can show, as far as set-ups and channels decide.
Context widest_context(const Campaign& campaign) {
  Context context;
  context.plant = kind_of(campaign.plant);
  context.belief = flattened(campaign.belief);
  for (const auto& channel : known_channels())
    if (channel.plant == campaign.plant)
      context.channels[std::string(channel.name)] = {.low = -1.0, .high = 1.0, .noise_rms = 1e-3};
  auto& facts = context.facts;
  facts.masses_differ = true;
  facts.foot_radius_ratio = 2.0;
  facts.range_of_pushes = facts.range_of_wait_s = facts.most_pushes = facts.longest_wait_s = 1.0;
  facts.floor_distance_m = facts.wetted_over_m = 0.1;
  facts.temperature_K = 10.0;
  facts.ripple_orders = {kFewestRipples};
  return context;
}

// A label of [effects]: "load_cell.inertia[force_N]#2".
struct Label {
  explicit Label(const std::string& text) {
    const auto plain = text.substr(0, text.find('#'));
    const auto open = plain.find('[');
    id = plain.substr(0, open);
    if (open != std::string::npos && plain.ends_with(']'))
      channel = plain.substr(open + 1, plain.size() - open - 2);
  }
  std::string id, channel{};
};

std::string did_you_mean(const std::string& word, const Names& known) {
  auto near = nearest_words(word, known);
  if (near.empty()) near = known;
  return near.empty() ? "" : fmt::format(": did you mean {}?", either(near));
}

class Refuser {
 public:
  explicit Refuser(const Campaign& campaign)
      : campaign_(campaign), context_(widest_context(campaign)), effects_(known_effects()) {
    std::erase_if(effects_, [&](const Effect& effect) {
      return std::ranges::find(effect.plants, context_.plant) == effect.plants.end();
    });
  }

  std::vector<ConfigProblem> run() {
    const auto document = parse_config_file(campaign_.model.string());
    if (const auto* table = document.root.find("effects"))
      for (const auto& node : table->children) check(node);
    return std::move(problems_);
  }

 private:
  void check(const ConfigNode& node) {
    const Label label(node.key);
    const auto effect = std::ranges::find(effects_, label.id, &Effect::id);
    if (effect == effects_.end()) {
      Names ids;
      for (const auto& known : effects_) ids.push_back(known.id);
      return refuse(node, fmt::format("no effect of plant \"{}\" is called '{}'{}", name_of(campaign_.plant),
                                      label.id, did_you_mean(label.id, ids)));
    }
    const Names channels = effect->channels ? effect->channels(context_) : Names{};
    if (!effect->channels && !label.channel.empty())
      return refuse(node, fmt::format("'{}' takes no channel: write \"{}\"", label.id, label.id));
    if (effect->channels && std::ranges::find(channels, label.channel) == channels.end()) {
      Names labels;
      for (const auto& channel : channels) labels.push_back(fmt::format("{}[{}]", label.id, channel));
      return refuse(node, fmt::format("'{}' needs the channel of its sensor in brackets{}", node.key,
                                      did_you_mean(node.key, labels)));
    }
    check_parameters(node, effect->parameters(context_, label.channel));
  }

  // An effect without parameters here cannot show in this context: its parameters are not known.
  void check_parameters(const ConfigNode& node, const std::vector<EffectParameter>& parameters) {
    Names names, own;
    for (const auto& parameter : parameters) {
      own.push_back(parameter.name);
      Names stated;
      for (const auto& name : names_in_effects(parameter)) {
        names.push_back(name);
        if (node.find(name) != nullptr) stated.push_back(name);
      }
      if (stated.size() > 1)
        refuse(*node.find(stated[1]), fmt::format("'{}' and '{}' of '{}' are the same parameter: state one",
                                                  stated[0], stated[1], node.key));
    }
    for (const auto& child : node.children)
      if (!names.empty() && std::ranges::find(names, child.key) == names.end())
        refuse(child, fmt::format("'{}' is no parameter of '{}'{}", child.key, node.key,
                                  did_you_mean(child.key, own)));
  }

  void refuse(const ConfigNode& node, std::string text) {
    problems_.push_back(
        {campaign_.model.string(), node.key_position, "effects." + node.key, std::move(text)});
  }

  const Campaign& campaign_;
  const Context context_;
  std::vector<Effect> effects_;
  std::vector<ConfigProblem> problems_{};
};

}  // namespace

void refuse_unknown_effects(const Campaign& campaign) {
  if (campaign.model.empty()) return;
  const auto problems = Refuser(campaign).run();
  if (!problems.empty()) throw ConfigError(problems);
}

}  // namespace sandhopper::diagnose
