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
  formats = repmat({'%f'}, 1, numel(names));
  formats(strcmp(names, 'phase')) = {'%s'};
  cells = textscan(id, [formats{:}], 'Delimiter', ',', 'EmptyValue', NaN);
  fclose(id);
  for k = 1:numel(names)
    column = cells{k};
    if iscell(column)  % phase: 0 flight, 1 compression, 2 extension
      [~, at] = ismember(column, {'flight', 'compression', 'extension', '0', '1', '2'});
      column = mod(at - 1, 3);
      column(at == 0) = NaN;
    end
    trial.(names{k}) = column;
  end
end
