% immaculate.is_asked(filter, problem): whether a filter is asked for a problem: by its format, and by the name of the problem's filter.
function result = is_asked(filter, problem)
  kind = problem.filter.kind;
  if strcmp(kind, 'cubature')
    kind = problem.filter.rule;
  elseif strcmp(kind, 'fixed-gain') && strcmp(problem.filter.mixing, 'unmixed')
    kind = 'fixed-gain-unmixed';
  end
  result = any(strcmp(problem.format, filter.formats)) && any(strcmp(kind, filter.kinds));
end
