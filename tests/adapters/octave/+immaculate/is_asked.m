% immaculate.is_asked(filter, problem): whether a filter is asked for a problem: by its format, and by the name of the problem's filter.
%
% Noises of motion and measurement that are correlated (M of a mode), modes with states of their own, and modes that do not start from mixed
% estimates (interaction), and chains in continuous time, are for filters that say so.
function result = is_asked(filter, problem)
  kind = problem.filter.kind;
  if strcmp(kind, 'cubature')
    kind = problem.filter.rule;
  elseif strcmp(kind, 'fixed-gain') && strcmp(problem.filter.mixing, 'unmixed')
    kind = 'fixed-gain-unmixed';
  elseif isfield(problem.filter, 'iterations') && problem.filter.iterations > 1
    kind = 'extended-iterated';
  end
  is_correlated = isfield(problem, 'modes') && iscell(problem.modes) && any(cellfun(@(mode) isfield(mode, 'M'), problem.modes));
  is_converted = isfield(problem, 'conversions');
  if is_correlated && ~any(strcmp('correlated-noise', filter.kinds)) || is_converted && ~any(strcmp('state-conversion', filter.kinds))
    result = false;
    return
  end
  if ~isfield(problem, 'transition') && ~any(strcmp('continuous-chain', filter.kinds))
    result = false;
    return
  end
  if isfield(problem, 'interaction') && ~any(strcmp(problem.interaction, [{'imm'}, filter.kinds(:)']))
    result = false;
    return
  end
  result = any(strcmp(problem.format, filter.formats)) && any(strcmp(kind, filter.kinds));
end
