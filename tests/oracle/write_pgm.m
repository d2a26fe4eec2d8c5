% Writes a logical width x height array as a binary PGM file with maximum value 1, rows
% from top to bottom.
function write_pgm(name, mask)
  file = fopen(name, "wb");
  if file < 0
    error("%s: cannot be written", name);
  end
  fprintf(file, "P5\n%d %d\n1\n", rows(mask), columns(mask));
  fwrite(file, mask(:), "uint8");
  fclose(file);
end
