// The torus of torus.toml at rest, for POV-Ray 3.7, whose axes are left-handed. Declare=Sturm=1 takes its careful solver.
#version 3.7;
global_settings { assumed_gamma 1.0 }
#ifndef (Sturm) #declare Sturm = 0; #end
camera { perspective location <0, 0, -5> look_at 0 right x*720/526 up y angle 50 }
light_source { <8, 12, -10> color rgb 1 }
torus {
  1.2, 0.5
  #if (Sturm) sturm #end
  rotate 50*x
  pigment { rgb <0.8, 0.3, 0.2> }
  finish { ambient 0 diffuse 0.8 phong 0.4 phong_size 40 }
}
