// Assignment of channels to panels. A channel that the trial lacks is left out, and so is a panel without
// channels. Channels are in SI units; a panel shows them times `scale`. A folded panel opens on request.
const PANELS = [
  {
    title: 'Leg length', unit: 'mm', scale: 1000, digits: 1,
    series: [{ channel: 'estimate_leg_length_m', label: 'from encoders', color: 'blue' }],
  },
  {
    title: 'Body height', unit: 'mm', scale: 1000, digits: 1,
    series: [
      { channel: 'tof_height_m', label: 'time of flight', color: 'grey', style: 'points' },
      { channel: 'mocap_body_z_m', label: 'motion capture', color: 'purple', style: 'points' },
      { channel: 'truth_body_z_m', label: 'truth', color: 'text', style: 'dashed' },
      { channel: 'estimate_body_z_m', label: 'estimate', color: 'blue' },
    ],
  },
  {
    title: 'Foot height', unit: 'mm', scale: 1000, digits: 1,
    series: [
      { channel: 'estimate_surface_z_m', label: 'surface', color: 'sand', style: 'steps' },
      { channel: 'mocap_foot_z_m', label: 'motion capture', color: 'purple', style: 'points' },
      { channel: 'truth_foot_z_m', label: 'truth', color: 'text', style: 'dashed' },
      { channel: 'estimate_foot_z_m', label: 'estimate', color: 'orange' },
    ],
  },
  {
    title: 'Velocity', unit: 'm/s', scale: 1, digits: 3,
    series: [
      { channel: 'truth_body_velocity_mps', label: 'body, truth', color: 'text', style: 'dashed' },
      { channel: 'truth_foot_velocity_mps', label: 'foot, truth', color: 'text', style: 'dashed' },
      { channel: 'estimate_body_velocity_mps', label: 'body', color: 'blue' },
      { channel: 'estimate_foot_velocity_mps', label: 'foot', color: 'orange' },
    ],
  },
  {
    title: 'Acceleration', unit: 'm/s²', scale: 1, digits: 1,
    series: [
      { channel: 'truth_body_accel_mps2', label: 'body, truth', color: 'text', style: 'dashed', shown: false },
      { channel: 'truth_foot_accel_mps2', label: 'foot, truth', color: 'text', style: 'dashed', shown: false },
      { channel: 'estimate_body_accel_mps2', label: 'body', color: 'blue' },
      { channel: 'estimate_foot_accel_mps2', label: 'foot', color: 'orange' },
      { channel: 'estimate_weighting_accel_mps2', label: 'foot, for weights', color: 'green', shown: false },
    ],
  },
  {
    title: 'Force of the ground', unit: 'N', scale: 1, digits: 1, tall: true,
    series: [
      { channel: 'load_cell_force_N', label: 'load cell', color: 'green' },
      { channel: 'truth_contact_force_N', label: 'truth', color: 'text', style: 'dashed' },
      { channel: 'quasi_static_force_N', label: 'quasi-static', color: 'orange' },
      { channel: 'estimate_contact_force_N', label: 'momentum observer', color: 'blue' },
    ],
  },
  {
    title: 'Torque of both motors', unit: 'N m', scale: 1, digits: 2,
    series: [
      { channel: 'truth_leg_torque_Nm', label: 'truth', color: 'text', style: 'dashed' },
      { channel: 'command_leg_torque_Nm', label: 'command', color: 'orange' },
      { channel: 'estimate_leg_torque_Nm', label: 'from currents', color: 'blue' },
    ],
  },
  {
    title: 'Innovation, heights', unit: 'mm', scale: 1000, digits: 2, folded: true,
    series: [
      { channel: 'innovation_tof_m', label: 'time of flight', color: 'grey', style: 'points' },
      { channel: 'innovation_leg_length_m', label: 'leg length', color: 'blue', style: 'points' },
    ],
  },
  {
    title: 'Innovation, leg rate', unit: 'm/s', scale: 1, digits: 3, folded: true,
    series: [{ channel: 'innovation_leg_rate_mps', label: 'leg rate', color: 'orange', style: 'points' }],
  },
  {
    title: 'Innovation squared over its variance', unit: '95 % below 3.84', scale: 1, digits: 2, folded: true,
    series: [
      { channel: 'normalised_tof', label: 'time of flight', color: 'grey', style: 'points' },
      { channel: 'normalised_leg_length', label: 'leg length', color: 'blue', style: 'points' },
      { channel: 'normalised_leg_rate', label: 'leg rate', color: 'orange', style: 'points' },
    ],
  },
];

// Treatments of the force-depth data, with their colours in all plots.
const TREATMENTS = [
  { key: 'qs_ols', label: 'quasi-static, OLS', color: 'orange' },
  { key: 'mo_ols', label: 'observer, OLS', color: 'purple' },
  { key: 'mo_wls', label: 'observer, weighted', color: 'blue' },
  { key: 'joint', label: 'joint fit', color: 'green' },
];
