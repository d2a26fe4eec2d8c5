% The oracle: renders a scene of spheres with the Whitted model (T. Whitted, "An
% Improved Illumination Model for Shaded Display", CACM 23(6), 1980), in double
% precision and straight from the equations. It shares nothing with the C++ renderer but
% the scene file, so two pictures that agree are two derivations that agree.
%
%   octave --no-gui --norc tests/oracle/whitted_oracle.m SCENE.pbrt OUT.pfm [MASK.pgm]
%
% OUT.pfm is linear RGB. MASK.pgm is 1 where a silhouette, a shadow edge or another
% change of the ray tree lies between the pixel and one of its eight neighbours.

addpath(fileparts(mfilename("fullpath")));

args = argv();
if numel(args) < 2 || numel(args) > 3
  error("usage: octave --no-gui --norc whitted_oracle.m SCENE.pbrt OUT.pfm [MASK.pgm]");
end

scene = read_scene(args{1});
start = tic();
[color, signature] = render(scene);
seconds = toc(start);
write_pfm(args{2}, color, scene.width, scene.height);
printf("%s: %d x %d, %d spheres, %d lights, depth %d: %.2f s\n", args{1}, ...
       scene.width, scene.height, rows(scene.centre), numel(scene.lights), ...
       scene.maxdepth, seconds);

if numel(args) == 3
  mask = edge_mask(reshape(signature, scene.width, scene.height));
  write_pgm(args{3}, mask);
  printf("edge mask: %.2f %% of the pixels\n", 100 * mean(mask(:)));
end
