#include "tools/campaign/sample_checks.hpp"

#include "tools/campaign/alternating_rows.hpp"
#include "tools/campaign/axis_torque_check.hpp"
#include "tools/campaign/begins_in_bed.hpp"
#include "tools/campaign/clock_checks.hpp"
#include "tools/campaign/depth_unit_check.hpp"
#include "tools/campaign/early_end.hpp"
#include "tools/campaign/fall_accel_check.hpp"
#include "tools/campaign/fall_check.hpp"
#include "tools/campaign/fall_kink.hpp"
#include "tools/campaign/fall_limits.hpp"
#include "tools/campaign/force_steps.hpp"
#include "tools/campaign/force_unit_check.hpp"
#include "tools/campaign/free_swing_check.hpp"
#include "tools/campaign/gravity_check.hpp"
#include "tools/campaign/held_heights.hpp"
#include "tools/campaign/hopper_check.hpp"
#include "tools/campaign/hopper_clock_check.hpp"
#include "tools/campaign/hopper_flight_check.hpp"
#include "tools/campaign/hopper_force_check.hpp"
#include "tools/campaign/hopper_height_check.hpp"
#include "tools/campaign/interpolated_samples.hpp"
#include "tools/campaign/lost_forces.hpp"
#include "tools/campaign/lost_frames.hpp"
#include "tools/campaign/peak_hold.hpp"
#include "tools/campaign/plausible.hpp"
#include "tools/campaign/press_speed_check.hpp"
#include "tools/campaign/rate_check.hpp"
#include "tools/campaign/repeated_code.hpp"
#include "tools/campaign/rest_before_fall.hpp"
#include "tools/campaign/sample_times.hpp"
#include "tools/campaign/sensor_signs.hpp"
#include "tools/campaign/sharp_turns.hpp"
#include "tools/campaign/surface_check.hpp"
#include "tools/campaign/surface_onset.hpp"
#include "tools/campaign/value_steps.hpp"

namespace sandhopper {
namespace {

void check_surfaces(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                    const RecordingPlaces& places) {
  const double surface_m = check_surface_onset(recording, campaign, trial, places);
  check_surface(recording, campaign, trial, places, surface_m);
  const bool pushes = trial.kind == TrialKind::intrusion || trial.kind == TrialKind::press;
  if (campaign.plant != CampaignPlant::intruder || !pushes) return;
  check_alternating_rows(recording, places);
  check_force_steps(recording, places);
  check_begins_in_bed(recording, trial, places);
}

}  // namespace

void check_samples(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                   const RecordingPlaces& places) {
  if (check_repeated_codes(recording, campaign, places)) return;
  check_held_samples(recording, places);
  check_held_heights(recording, campaign, places);
  check_interpolated(recording, places);
  const bool holds_peak = check_peak_hold(recording, trial, places);
  if (!holds_peak) check_lost_forces(recording, places);
  check_plausible(recording, campaign, trial, places);
  check_overburden(recording, campaign, trial, places);
  check_depth_unit(recording, campaign, trial, places);
  check_force_unit(recording, campaign, trial, places, note_early_end(recording, places));
  check_rates(recording, places);
  check_gravity(recording, places);
  check_falls(recording, campaign, trial, places);
  check_fall_limits(recording, campaign, trial, places);
  check_rest_before_fall(recording, campaign, trial, places);
  check_press_speed(recording, campaign, trial, places);
  check_free_swing(recording, campaign, trial, places);
  check_axis_torque(recording, campaign, trial, places);
  check_hopper_flight(recording, campaign, trial, places);
  check_hopper(recording, campaign, trial, places);
  if (!check_fall_acceleration(recording, campaign, trial, places))
    check_signs(recording, campaign, trial, places);
  check_push_signs(recording, campaign, trial, places);
  check_hopper_heights(recording, campaign, trial, places);
  check_hopper_forces(recording, campaign, trial, places);
  check_hopper_clock(recording, campaign, trial, places);
  if (!holds_peak) check_surfaces(recording, campaign, trial, places);
  check_value_steps(recording, places);
  check_sharp_turns(recording, places);
  check_fall_kink(recording, campaign, places);
  check_clock_steps(recording, places);
  check_lost_frames(recording, places);
}

void check_press(TrialRecording& recording, const Campaign& campaign, const CampaignTrial& trial,
                 const RecordingPlaces& places) {
  check_lost_forces(recording, places);
  check_overburden(recording, campaign, trial, places);
  check_force_unit(recording, campaign, trial, places);
  check_push_signs(recording, campaign, trial, places);
  check_surfaces(recording, campaign, trial, places);
}

}  // namespace sandhopper
