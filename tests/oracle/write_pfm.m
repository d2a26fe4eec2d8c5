% Writes linear RGB floats as a PFM file: rows from bottom to top, little endian.
% `picture` is (width * height) x 3, along x first, from the top row down.
function write_pfm(name, picture, width, height)
  cube = reshape(picture, width, height, 3);
  cube = permute(cube(:, end:-1:1, :), [3, 1, 2]);
  file = fopen(name, "wb");
  if file < 0
    error("%s: cannot be written", name);
  end
  fprintf(file, "PF\n%d %d\n-1.0\n", width, height);
  fwrite(file, cube(:), "single", 0, "ieee-le");
  fclose(file);
end
