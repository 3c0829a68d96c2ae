% now = immaculate.step_of(problem, k): what holds in step k of a problem from immaculate.read_problem.
%
%   now.z             the entries that are present; empty without a detection
%   now.rows          which of the sensor's entries these are
%   now.R             their noise
%   now.measurement   the measurement, with H, components and is_angle of these entries only
%   now.F{j}, now.Q{j}, now.transition, now.T
%
% F{j} and Q{j} are empty or not numeric if the mode has formulas or a named model. jsondecode turns a null inside a list of numbers
% into NaN: a missing entry of z is NaN there, and is omitted here.
function now = step_of(problem, k)
  entry = problem.measurements{k};
  source = problem;
  if isfield(entry, 'sensor')
    is_it = cellfun(@(sensor) strcmp(sensor.name, entry.sensor), problem.sensors);
    source = problem.sensors{is_it};
  end
  now.measurement = source.measurement;
  if isfield(entry, 'H')
    now.measurement.H = entry.H;
  end
  now.R = either(entry, 'R', source.R);
  now.z = entry.z(:);
  now.rows = find(~isnan(now.z))';
  if numel(now.rows) < numel(now.z)
    now = only(now);
  end
  now.transition = either(entry, 'transition', problem.transition);
  now.T = [];
  if isfield(problem, 'parameters')
    now.T = either(problem.parameters, 'T', []);
  end
  now.T = either(entry, 'T', now.T);
  r = numel(problem.modes);
  now.F = cell(1, r);
  now.Q = cell(1, r);
  for j = 1:r
    now.F{j} = of_mode(entry, 'F', j, either(problem.modes{j}, 'F', []));
    now.Q{j} = of_mode(entry, 'Q', j, problem.modes{j}.Q);
  end
end

function value = either(object, name, value)
  if isfield(object, name)
    value = object.(name);
  end
end

% jsondecode makes a list of matrices an array with the list as its first dimension.
function value = of_mode(entry, name, j, value)
  if isfield(entry, name)
    n = size(entry.(name), 2);
    value = reshape(entry.(name)(j, :, :), n, n);
  end
end

function now = only(now)
  now.z = now.z(now.rows);
  now.R = now.R(now.rows, now.rows);
  for name = {'is_angle', 'components', 'z', 'h'}
    if isfield(now.measurement, name{1}) && ~isempty(now.measurement.(name{1}))
      now.measurement.(name{1}) = now.measurement.(name{1})(now.rows);
    end
  end
  if isfield(now.measurement, 'H')
    now.measurement.H = now.measurement.H(now.rows, :);
  end
end
