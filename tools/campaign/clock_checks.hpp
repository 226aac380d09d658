#pragma once
#include "firmware/log/csv_import.hpp"
#include "tools/campaign/check_channels.hpp"

namespace sandhopper {

// A gap that no motion crosses: the positions go on by one row's step, at a speed that is the same on both
// sides. The clock stepped forward, as one does that a network sets. The trial is lost unless [columns]
// states unit and scale of t_s.
void check_clock_steps(TrialRecording& recording, const RecordingPlaces& places);

// A second column of times that goes away from the time of the rows: each sensor has its own times, and a row
// holds values of different instants. A column that is called a time but states no unit may be a counter: it
// gets a note, except if the time of the rows states none either and both cover the same span to the nearest
// power of ten. Two clocks of one instant drift apart by less: a crystal by 1e-4 of the
// time, an RC oscillator by about 1 %.
void check_other_clocks(TrialRecording& recording, const CsvTable& table, std::size_t time_column,
                        const RecordingPlaces& places);

}  // namespace sandhopper
