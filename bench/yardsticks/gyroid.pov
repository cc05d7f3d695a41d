// The gyroid of gyroid.toml at rest, for POV-Ray 3.7, whose axes are left-handed: x is mirrored in the function too.
// Declare=Accuracy=1e-6 changes the accuracy. The greatest gradient is the square root of 3.
#version 3.7;
global_settings { assumed_gamma 1.0 }
#ifndef (Accuracy) #declare Accuracy = 1e-3; #end
camera { perspective location <9, 11, -21> look_at 0 right x*720/526 up y angle 45 }
light_source { <-20, 30, -30> color rgb 1 }
isosurface {
  function { sin(-x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x) }
  contained_by { box { -2*pi, 2*pi } }
  open
  max_gradient 1.75
  accuracy Accuracy
  pigment { rgb <0.3, 0.6, 0.8> }
  finish { ambient 0 diffuse 0.8 phong 0.4 phong_size 40 }
}
