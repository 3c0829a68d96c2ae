% immaculate.write_answer(folder, answer, form): writes an answer where `immaculate check --answers FOLDER` looks for it.
%
% The form is 'json' or 'csv': a long table with one number per line, which cannot carry an error or the reason for a skip. The JSON is
% written here, because Octave's jsonencode writes numbers below 2.2e-16 as 0, small probabilities too.
function write_answer(folder, answer, form)
  if strcmp(form, 'csv') && isfield(answer, 'steps') && ~isfield(answer, 'error')
    write_text(fullfile(folder, [answer.id '.csv']), table_of(answer));
  else
    write_text(fullfile(folder, [answer.id '.json']), json(answer));
  end
end

function text = json(value)
  if isstruct(value)
    names = fieldnames(value);
    parts = cell(1, numel(names));
    for i = 1:numel(names)
      parts{i} = ['"' names{i} '": ' json(value.(names{i}))];
    end
    text = ['{' strjoin(parts, ', ') '}'];
  elseif iscell(value)
    parts = cell(1, numel(value));
    for i = 1:numel(value)
      parts{i} = json(value{i});
    end
    text = ['[' strjoin(parts, ', ') ']'];
  elseif ischar(value)
    text = jsonencode(value);
  elseif isscalar(value)
    text = numbers(value);
  elseif iscolumn(value)
    text = ['[' numbers(value) ']'];
  else
    parts = cell(1, size(value, 1));
    for i = 1:size(value, 1)
      parts{i} = ['[' numbers(value(i, :)) ']'];
    end
    text = ['[' strjoin(parts, ', ') ']'];
  end
end

% Numbers with commas between them; what is not finite is null.
function text = numbers(values)
  text = sprintf('%.17g, ', values);
  text = text(1:end - 2);
  if ~all(isfinite(values))
    text = regexprep(text, '-?(NaN|Inf)', 'null');
  end
end

function text = table_of(answer)
  lines = {sprintf('id,step,mode,quantity,row,column,value\n')};
  for k = 1:numel(answer.steps)
    step = answer.steps{k};
    lines = [lines, rows(answer.id, k, '', '', rmfield(step, intersect(fieldnames(step), {'step', 'modes'})))];
    if isfield(step, 'modes')
      for j = 1:numel(step.modes)
        lines = [lines, rows(answer.id, k, num2str(j), '', step.modes{j})];
      end
    end
  end
  text = strjoin(lines, '');
end

function lines = rows(id, k, mode, prefix, shown)
  lines = {};
  names = fieldnames(shown);
  for q = 1:numel(names)
    value = shown.(names{q});
    name = [prefix names{q}];
    if isstruct(value)
      lines = [lines, rows(id, k, mode, [name '.'], value)];
      continue
    end
    row = repmat((1:size(value, 1))', 1, size(value, 2));
    column = repmat(1:size(value, 2), size(value, 1), 1);
    format = sprintf('%s,%d,%s,%s,%%d,%%d,%%.17g\\n', id, k, mode, name);
    lines{end + 1} = sprintf(format, [row(:), column(:), value(:)]');
  end
end

function write_text(name, text)
  file = fopen(name, 'w');
  if file < 0
    error('immaculate:file', '%s cannot be written', name);
  end
  fprintf(file, '%s', text);
  fclose(file);
end
