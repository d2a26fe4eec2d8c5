% True where any sphere lies between a point on sphere `from` and the light. `to_light`
% reaches from the point to the light, so the light is at t = 1.
function hidden = shadowed(scene, point, to_light, from)
  hidden = false(rows(point), 1);
  for k = 1:rows(scene.centre)
    [near, far] = sphere_roots(point, to_light, scene.centre(k, :), scene.radius(k), from == k);
    hidden |= (near > 0 & near < 1) | (far > 0 & far < 1);
  end
end
