% Colour and signature (see trace_rays) of every pixel: along x first, from the top down.
function [color, signature] = render(scene)
  block = 65536;   % rays at a time, which bounds the memory
  [origin, direction] = camera_rays(scene);
  count = rows(direction);
  color = zeros(count, 3);
  signature = zeros(count, 1);
  for first = 1:block:count
    part = first:min(first + block - 1, count);
    [color(part, :), signature(part)] = trace_rays(scene, origin(part, :), ...
        direction(part, :), zeros(numel(part), 1), scene.maxdepth, ones(numel(part), 1));
  end
end
