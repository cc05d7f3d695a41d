// Barth's sextic of barth.toml at rest, for POV-Ray 3.7, whose axes are left-handed: a polynomial (Declare=Sturm=1: with its
// careful solver), or an isosurface with Declare=Accuracy=1e-4. The greatest gradient in the box is 200.
#version 3.7;
global_settings { assumed_gamma 1.0 }
#ifndef (Sturm) #declare Sturm = 0; #end
#ifndef (Accuracy) #declare Accuracy = 0; #end
camera { perspective location <1.2, 2, -5> look_at 0 right x*720/526 up y angle 45 }
light_source { <8, 12, -10> color rgb 1 }
#declare A = 2.618033988749895;
#declare B = 4.23606797749979;
#if (Accuracy > 0)
isosurface {
  function { 4*(A*x*x - y*y)*(A*y*y - z*z)*(A*z*z - x*x) - B*pow(x*x + y*y + z*z - 1, 2) }
  contained_by { box { -1.9, 1.9 } }
  open
  max_gradient 200
  accuracy Accuracy
#else
polynomial {
  6,
  xyz(2,2,2): 4*(A*A*A - 1),
  xyz(4,2,0): -4*A*A, xyz(0,4,2): -4*A*A, xyz(2,0,4): -4*A*A,
  xyz(4,0,2): 4*A, xyz(2,4,0): 4*A, xyz(0,2,4): 4*A,
  xyz(4,0,0): -B, xyz(0,4,0): -B, xyz(0,0,4): -B,
  xyz(2,2,0): -2*B, xyz(2,0,2): -2*B, xyz(0,2,2): -2*B,
  xyz(2,0,0): 2*B, xyz(0,2,0): 2*B, xyz(0,0,2): 2*B,
  xyz(0,0,0): -B
  #if (Sturm) sturm #end
  clipped_by { box { -1.9, 1.9 } }
  bounded_by { clipped_by }
#end
  pigment { rgb <0.8, 0.7, 0.2> }
  finish { ambient 0 diffuse 0.8 phong 0.4 phong_size 40 }
}
