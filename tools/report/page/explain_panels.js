// Measurements around a fault, by panel. Channels are in SI units; a panel shows them times `scale`. Left and
// right often have equal values, so the right one is dashed and both remain visible.
const sides = (channel, label = '') => [
  { channel: channel.replace('SIDE', 'left'), label: `left${label}`, color: 'blue' },
  { channel: channel.replace('SIDE', 'right'), label: `right${label}`, color: 'orange', style: 'dashed' },
];
const PANELS = [
  { title: 'E-stop line', unit: '1: open', scale: 1, digits: 0, series: [{ channel: 'emergency_stop', label: 'open', color: 'orange', style: 'steps' }] },
  { title: 'Age of the newest reply', unit: 'ms', scale: 1000, digits: 1, series: sides('motor_SIDE_reply_age_s') },
  { title: 'Angle of the upper links', unit: 'rad', scale: 1, digits: 3, series: sides('motor_SIDE_position_rad') },
  { title: 'Speed of the motors', unit: 'rad/s', scale: 1, digits: 2, series: sides('motor_SIDE_velocity_radps') },
  { title: 'Current', unit: 'A', scale: 1, digits: 1, series: sides('motor_SIDE_current_A') },
  { title: 'Commanded torque', unit: 'N m', scale: 1, digits: 2, series: sides('command_SIDE_torque_Nm') },
  { title: 'Commanded damping', unit: 'N m s/rad', scale: 1, digits: 2, series: sides('command_SIDE_damping_Nm_s_per_rad') },
  { title: 'Temperature of the drives', unit: '°C', scale: 1, digits: 0, series: sides('motor_SIDE_temperature_C') },
  { title: 'Supply voltage', unit: 'V', scale: 1, digits: 1, series: sides('motor_SIDE_voltage_V') },
  {
    title: 'Force of the ground', unit: 'N', scale: 1, digits: 1,
    series: [
      { channel: 'load_cell_N', label: 'load cell, tare included', color: 'green' },
      { channel: 'estimate_contact_force_N', label: 'momentum observer', color: 'blue' },
    ],
  },
  {
    title: 'Acceleration along z', unit: 'm/s²', scale: 1, digits: 1,
    series: [
      { channel: 'imu_body_accel_z_mps2', label: 'body', color: 'blue' },
      { channel: 'imu_foot_accel_z_mps2', label: 'foot', color: 'orange' },
    ],
  },
  {
    title: 'Rates of the body', unit: 'rad/s', scale: 1, digits: 2,
    series: [
      { channel: 'imu_body_gyro_x_radps', label: 'about x', color: 'blue' },
      { channel: 'imu_body_gyro_y_radps', label: 'about y', color: 'orange' },
    ],
  },
  {
    title: 'Height of the body', unit: 'mm', scale: 1000, digits: 1,
    series: [
      { channel: 'tof_height_m', label: 'time of flight', color: 'grey', style: 'points' },
      { channel: 'estimate_body_z_m', label: 'estimate', color: 'blue' },
    ],
  },
  { title: 'Height of the foot', unit: 'mm', scale: 1000, digits: 1, series: [{ channel: 'estimate_foot_z_m', label: 'estimate', color: 'orange' }] },
  { title: 'Leg length', unit: 'mm', scale: 1000, digits: 1, series: [{ channel: 'estimate_leg_length_m', label: 'from encoders', color: 'blue' }] },
  {
    title: 'Velocity', unit: 'm/s', scale: 1, digits: 3,
    series: [
      { channel: 'estimate_body_velocity_mps', label: 'body', color: 'blue' },
      { channel: 'estimate_foot_velocity_mps', label: 'foot', color: 'orange' },
    ],
  },
  {
    title: 'Age of the newest sample', unit: 'ms', scale: 1000, digits: 1,
    series: [
      { channel: 'imu_body_age_s', label: 'body IMU', color: 'blue' },
      { channel: 'imu_foot_age_s', label: 'foot IMU', color: 'orange' },
      { channel: 'tof_age_s', label: 'time of flight', color: 'grey' },
      { channel: 'load_cell_age_s', label: 'load cell', color: 'green' },
    ],
  },
  {
    title: 'Bus, since the first cycle shown', unit: 'frames', scale: 1, digits: 0,
    series: [
      { channel: 'bus_errors', label: 'errors', color: 'orange', style: 'steps' },
      { channel: 'bus_no_acknowledge', label: 'no acknowledge', color: 'purple', style: 'steps' },
      { channel: 'bus_send_failures', label: 'not sent', color: 'blue', style: 'steps' },
      { channel: 'bus_overflows', label: 'dropped', color: 'sand', style: 'steps' },
      { channel: 'bus_rejected', label: 'other dialect', color: 'green', style: 'steps' },
      { channel: 'bus_unsolicited', label: 'not asked for', color: 'grey', style: 'steps' },
    ],
  },
  { title: 'State of the CAN controller', unit: '0 active, 1 warning, 2 passive, 3 off', scale: 1, digits: 0, series: [{ channel: 'bus_state', label: 'state', color: 'purple', style: 'steps' }] },
  { title: 'From one cycle to the next', unit: 'ms', scale: 1000, digits: 1, series: [{ channel: 'cycle_step_s', label: 'step', color: 'purple' }] },
];
