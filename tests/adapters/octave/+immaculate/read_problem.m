% problem = immaculate.read_problem(file): a problem as MATLAB and Octave have it, whatever jsondecode makes of the file.
%
% Lists of objects are cells: problem.modes{j}, problem.initial.modes{j}, problem.measurements{k}, problem.sensors{s}. Matrices are
% matrices, lists of numbers are columns. problem.state has the names, problem.is_angle says which are angles. A measurement
% has is_angle, one an entry of z. Nothing else is renamed; what `problem.measurement.position` points at counts from 0.
% immaculate.step_of gives the models of a step and the entries of z that are present.
function problem = read_problem(file)
  problem = jsondecode(fileread(file));
  problem.modes = immaculate.cells(problem.modes);
  problem.initial.modes = immaculate.cells(problem.initial.modes);
  problem.measurements = immaculate.cells(problem.measurements);
  if ~isfield(problem, 'sensors')
    problem.sensors = {};
  end
  problem.sensors = immaculate.cells(problem.sensors);
  if ~isfield(problem, 'conventions')
    problem.conventions = struct();
  end
  [problem.state, problem.is_angle] = components(problem.state);
  problem.measurement = with_angles(problem.measurement);
  for s = 1:numel(problem.sensors)
    problem.sensors{s}.measurement = with_angles(problem.sensors{s}.measurement);
  end
end

% An entry of the state or of z is a name, [name, unit] or [name, unit, 'angle'].
function [names, is_angle] = components(list)
  names = cell(1, numel(list));
  is_angle = false(1, numel(list));
  for i = 1:numel(list)
    entry = cellstr(list{i});
    names{i} = entry{1};
    is_angle(i) = numel(entry) > 2 && strcmp(entry{3}, 'angle');
  end
end

function measurement = with_angles(measurement)
  switch measurement.kind
    case 'range-bearing'
      measurement.is_angle = strcmp(measurement.components(:)', 'bearing');
    case 'formulas'
      [~, measurement.is_angle] = components(measurement.z);
    otherwise
      measurement.is_angle = [];                       % nothing is one, or the model knows
  end
end
