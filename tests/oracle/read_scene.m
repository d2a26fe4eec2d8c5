% Reads the part of the pbrt-v4 scene language that the oracle's scenes use. Whatever is
% not known here is an error: the oracle must never render a scene it only half
% understood. The result holds one row per sphere (centre, radius, material numbers), a
% list of lights, the camera and the integrator's parameters.
function scene = read_scene(name)
  tokens = read_tokens(name);
  scene = struct("width", 1280, "height", 720, "fov", 90, "camera_from_world", [], ...
      "maxdepth", 5, "ambient", [0.1 0.1 0.1], "shadows", true, ...
      "centre", zeros(0, 3), "radius", zeros(0, 1), "lights", struct([]));
  state = struct("ctm", eye(4), "material", []);
  named = containers.Map();
  stack = {};
  materials = {};
  at = 1;
  while at <= numel(tokens)
    word = tokens{at};
    if isfield(numbers_of(), word)
      [state, stack, at] = state_directive(name, tokens, at, state, stack);
      continue;
    end
    [type, p, at] = read_parameters(name, tokens, at);
    switch word
      case "MakeNamedMaterial"
        named(type) = phong(p.string_type, rmfield(p, "string_type"));
      case "NamedMaterial"
        state.material = named(type);
      case "Material"
        state.material = phong(type, p);
      case "LightSource"
        scene.lights = [scene.lights, point_light(type, p, state.ctm)];
      case "Shape"
        [scene, materials] = add_sphere(scene, materials, type, p, state);
      otherwise
        scene = set_option(scene, word, type, p, state.ctm);
    end
  end
  if !scene.shadows
    error("%s: the oracle always casts shadows", name);
  end
  scene = add_materials(scene, materials);
end

% The directives that change the graphics state, with the count of numbers after each.
function counts = numbers_of()
  counts = struct("LookAt", 9, "Translate", 3, "Scale", 3, "Rotate", 4, "Identity", 0, ...
                  "WorldBegin", 0, "AttributeBegin", 0, "AttributeEnd", 0);
end

function [state, stack, at] = state_directive(name, tokens, at, state, stack)
  word = tokens{at};
  count = numbers_of().(word);
  switch word
    case "WorldBegin"
      state.ctm = eye(4);
    case "AttributeBegin"
      stack{end + 1} = state;
    case "AttributeEnd"
      state = stack{end};
      stack(end) = [];
    otherwise
      v = str2double(tokens(at + 1:at + count));
      if any(isnan(v))
        error("%s: %s needs %d numbers", name, word, count);
      end
      state.ctm = transform(state.ctm, word, v);
  end
  at += 1 + count;
end

% Splits a file into quoted strings (quotes kept), brackets and words, without comments.
function tokens = read_tokens(name)
  text = fileread(name);
  text = regexprep(text, '#[^\n]*', '');
  tokens = regexp(text, '"[^"\n]*"|[\[\]]|[^\s\[\]"]+', 'match');
end

% Reads `Word "type" "float x" 1 "rgb c" [...] ...` from tokens{at}. The parameters come
% back in a struct whose fields are called type_name; `at` is moved behind them.
function [type, p, at] = read_parameters(name, tokens, at)
  word = tokens{at};
  if at == numel(tokens) || tokens{at + 1}(1) != '"'
    error("%s: unknown directive %s", name, word);
  end
  type = tokens{at + 1}(2:end - 1);
  p = struct();
  at += 2;
  while at <= numel(tokens) && tokens{at}(1) == '"'
    key = strjoin(regexp(tokens{at}(2:end - 1), '\S+', 'match'), "_");
    last = at + 1;
    values = tokens(last);
    if strcmp(tokens{last}, "[")
      while !strcmp(tokens{last}, "]")
        last += 1;
      end
      values = tokens(at + 2:last - 1);
    end
    p.(key) = parameter_value(key, values);
    at = last + 1;
  end
end

function value = parameter_value(key, values)
  if strncmp(key, "string_", 7)
    value = values{1}(2:end - 1);
  elseif strncmp(key, "bool_", 5)
    value = strcmp(values{1}, "true");
  else
    value = str2double(values);
    if any(isnan(value))
      error("%s: not a number", key);
    end
  end
end

% The value of a parameter, or its default; `p` loses it, so that what is left over at
% the end is what the oracle does not know.
function [value, p] = take(p, key, value)
  if isfield(p, key)
    value = p.(key);
    p = rmfield(p, key);
  end
end

function nothing_left(p, what)
  left = fieldnames(p);
  if !isempty(left)
    error("%s: parameter '%s' is unknown to the oracle", what, left{1});
  end
end

function ctm = transform(ctm, word, v)
  switch word
    case "Identity"
      ctm = eye(4);
      return;
    case "Translate"
      m = [eye(3), v(:); 0 0 0 1];
    case "Scale"
      m = diag([v(:); 1]);
    case "Rotate"
      axis = v(2:4)(:) / norm(v(2:4));
      K = [0, -axis(3), axis(2); axis(3), 0, -axis(1); -axis(2), axis(1), 0];
      m = eye(4);
      m(1:3, 1:3) += sind(v(1)) * K + (1 - cosd(v(1))) * K * K;   % Rodrigues
    case "LookAt"
      eye_point = v(1:3)(:);
      forward = v(4:6)(:) - eye_point;
      forward /= norm(forward);
      right = cross(v(7:9)(:), forward);
      right /= norm(right);
      m = inv([right, cross(forward, right), forward, eye_point; 0 0 0 1]);
  end
  ctm = ctm * m;
end

function scene = set_option(scene, word, type, p, ctm)
  switch [word, " ", type]
    case "Integrator whitted"
      [scene.maxdepth, p] = take(p, "integer_maxdepth", scene.maxdepth);
      [scene.ambient, p] = take(p, "rgb_ambient", scene.ambient);
      [scene.shadows, p] = take(p, "bool_shadows", scene.shadows);
    case "Film rgb"
      [scene.width, p] = take(p, "integer_xresolution", scene.width);
      [scene.height, p] = take(p, "integer_yresolution", scene.height);
      [~, p] = take(p, "string_filename", "");       % the picture's name and its encoding
      [~, p] = take(p, "string_transfer", "");       % do not change the linear values
    case "Camera perspective"
      [scene.fov, p] = take(p, "float_fov", scene.fov);
      scene.camera_from_world = ctm;
    case {"Sampler independent", "PixelFilter box"}
      % One ray through the pixel's centre, whatever the pattern would be.
      [samples, p] = take(p, "integer_pixelsamples", 1);
      if samples != 1
        error("the oracle takes one sample a pixel");
      end
    otherwise
      error("%s \"%s\" is unknown to the oracle", word, type);
  end
  nothing_left(p, word);
end

function m = phong(type, p)
  if !strcmp(type, "phong")
    error("material \"%s\" is unknown to the oracle", type);
  end
  [m.diffuse, p] = take(p, "rgb_diffuse", [0.5 0.5 0.5]);
  [m.ambient_color, p] = take(p, "rgb_ambient", m.diffuse);
  [m.specular, p] = take(p, "rgb_specular", [1 1 1]);
  [m.shininess, p] = take(p, "float_shininess", 50);
  [m.reflectivity, p] = take(p, "float_reflectivity", 0);
  [m.transparency, p] = take(p, "float_transparency", 0);
  [m.eta, p] = take(p, "float_eta", 1.5);
  nothing_left(p, "phong");
end

function light = point_light(type, p, ctm)
  if !strcmp(type, "point")
    error("light \"%s\" is unknown to the oracle", type);
  end
  [intensity, p] = take(p, "rgb_I", [1 1 1]);
  [scale, p] = take(p, "float_scale", 1);
  [from, p] = take(p, "point3_from", [0 0 0]);
  [falloff, p] = take(p, "string_falloff", "inversesquare");
  nothing_left(p, "point light");
  light.from = (ctm * [from(:); 1])(1:3)';
  light.intensity = intensity * scale;
  light.inverse_square = !strcmp(falloff, "none");
end

function [scene, materials] = add_sphere(scene, materials, type, p, state)
  if !strcmp(type, "sphere")
    error("shape \"%s\" is unknown to the oracle", type);
  end
  if isempty(state.material)
    error("a sphere without a phong material is unknown to the oracle");
  end
  [radius, p] = take(p, "float_radius", 1);
  nothing_left(p, "sphere");
  linear = state.ctm(1:3, 1:3);
  scale = norm(linear(:, 1));
  if norm(linear' * linear - scale ^ 2 * eye(3), "fro") > 1e-12 * scale ^ 2
    error("a sphere that is no longer round is unknown to the oracle");
  end
  scene.centre(end + 1, :) = state.ctm(1:3, 4)';
  scene.radius(end + 1, 1) = radius * scale;
  materials{end + 1} = state.material;
end

% Turns the list of materials into one column (or three, for colours) per property.
function scene = add_materials(scene, materials)
  for field = {"diffuse", "ambient_color", "specular", "shininess", "reflectivity", ...
               "transparency", "eta"}
    scene.(field{1}) = cell2mat(cellfun(@(m) m.(field{1}), materials(:), "UniformOutput", false));
  end
end
