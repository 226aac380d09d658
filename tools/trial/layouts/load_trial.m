function trial = load_trial(file)
% A trial as `hop export TRIAL.mcap` writes it; for MATLAB and GNU Octave, no toolbox.
%   trial = load_trial('trial_001.csv');
%   plot(trial.t_s, trial.load_cell_force_N, '.')
% A field per column, in SI units (the unit is the end of the name); NaN: no fresh sample in that cycle.
  id = fopen(file, 'r');
  if id < 0
    error('load_trial: cannot open %s', file);
  end
  names = strsplit(strtrim(fgetl(id)), ',');
  cells = textscan(id, repmat('%f', 1, numel(names)), 'Delimiter', ',', 'EmptyValue', NaN, 'CollectOutput', true);
  fclose(id);
  for k = 1:numel(names)
    trial.(names{k}) = cells{1}(:, k);
  end
end
