% list = immaculate.cells(list): a list of objects as cells; jsondecode makes an array of structures of objects with the same keys.
function list = cells(list)
  if isstruct(list)
    list = num2cell(list);
  end
end
