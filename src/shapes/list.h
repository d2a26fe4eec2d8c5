// The shapes there are. Adding one: a file of its own, and a line here.
KIND(sphere)
KIND(disk)
KIND(cylinder)
KIND(trianglemesh)
KIND(plymesh)
KIND(bilinearmesh)
KIND(sdf)
KIND(sdfgrid)
