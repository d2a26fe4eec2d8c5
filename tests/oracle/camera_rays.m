% One ray through the centre of every pixel of a perspective camera, as pbrt-v4 places
% it: camera space is left-handed (x right, y up, z forward) and the field of view spans
% the shorter side of the picture. Rows of the result run along x first, then down y;
% directions have unit length.
function [origin, direction] = camera_rays(scene)
  width = scene.width;
  height = scene.height;
  [i, j] = ndgrid(0:width - 1, 0:height - 1);        % i from the left, j from the top
  half = tand(scene.fov / 2) / min(width, height);   % half a pixel at distance 1
  x = (2 * (i(:) + 0.5) - width) * half;
  y = (height - 2 * (j(:) + 0.5)) * half;

  world_from_camera = inv(scene.camera_from_world);
  direction = [x, y, ones(width * height, 1)] * world_from_camera(1:3, 1:3)';
  direction ./= sqrt(sum(direction .^ 2, 2));
  origin = repmat(world_from_camera(1:3, 4)', width * height, 1);
end
