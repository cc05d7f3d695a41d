// Frame mix-ups do not compile, and what looks like them but is right does.
//
// Everything here is asserted by the compiler: a mix-up that begins to compile breaks the build of this file.
#include <gtest/gtest.h>

#include <concepts>
#include <type_traits>

#include "backlight/colour/brightness.h"
#include "backlight/spacetime/transform.h"

namespace backlight {
namespace {

template <class A, class B>
concept adds = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept subtracts = requires(A a, B b) {
  a - b;
};
template <class A, class B>
concept multiplies = requires(A a, B b) {
  a* b;
};
template <class A, class B>
concept compares = requires(A a, B b) {
  a == b;
};
template <class A, class B>
concept orders = requires(A a, B b) {
  a < b;
};
template <class Function, class Argument>
concept applies_to = requires(const Function f, Argument a) {
  f(a);
};
template <class Target, class Value>
concept assigns = requires(Target target, Value value) {
  target = value;
};
template <class A, class B>
concept has_interval = requires(A a, B b) {
  interval(a - b);
};

// Events and displacements.
static_assert(subtracts<Event<World>, Event<World>>);
static_assert(adds<Event<World>, Displacement<World>>);
static_assert(adds<Displacement<Rest>, Displacement<Rest>>);
static_assert(std::same_as<decltype(Event<World>{} - Event<World>{}), Displacement<World>>);
static_assert(std::same_as<decltype(Event<Rest>{} + Displacement<Rest>{}), Event<Rest>>);

static_assert(!adds<Event<World>, Event<World>>, "two events do not add");
static_assert(!subtracts<Event<World>, Event<Rest>>, "events of two frames have no difference");
static_assert(!adds<Event<World>, Displacement<Rest>>);
static_assert(!adds<Displacement<World>, Displacement<Rest>>);
static_assert(!subtracts<Displacement<World>, Displacement<Rest>>);
static_assert(!subtracts<Displacement<World>, Event<World>>);
static_assert(!multiplies<double, Event<World>>, "twice an event means nothing");
static_assert(multiplies<double, Displacement<World>>);
static_assert(has_interval<Event<World>, Event<World>>);
static_assert(!has_interval<Event<World>, Event<Camera>>);

// Numbers get their frame where they are made, and only there.
static_assert(assigns<Event<World>, Event<World>>);
static_assert(!assigns<Event<World>, Event<Rest>>);
static_assert(!assigns<Event<World>, Displacement<World>>, "an event is no displacement");
static_assert(!assigns<Displacement<World>, Event<World>>);
static_assert(!assigns<Displacement<World>, Vec3>);
static_assert(!assigns<NullDirection<Rest>, NullDirection<Camera>>);
static_assert(!assigns<NullDirection<Rest>, Displacement<Rest>>, "a displacement need not be null");
static_assert(!assigns<NullDirection<Rest>, Vec3>);
static_assert(!assigns<Vec3, NullDirection<Rest>>);
static_assert(!std::convertible_to<Vec3, NullDirection<Rest>>);
static_assert(!std::convertible_to<Event<Rest>, Event<Source>>, "a lamp's frame is not the object's");

// Comparing what is of two frames.
static_assert(!compares<Event<World>, Event<Rest>>);
static_assert(!compares<Displacement<World>, Displacement<Rest>>);
static_assert(!orders<DopplerFactor<Camera, Rest>, DopplerFactor<Rest, Source>>);

// Transformations take what is in their From, and give what is in their To.
using RestFromWorld = LorentzTransform<Rest, World>;
using WorldFromRest = LorentzTransform<World, Rest>;
static_assert(applies_to<RestFromWorld, Displacement<World>>);
static_assert(applies_to<RestFromWorld, NullDirection<World>>);
static_assert(std::same_as<decltype(RestFromWorld{}(NullDirection<World>{})), NullDirection<Rest>>);
static_assert(std::same_as<decltype(RestFromWorld{}(Displacement<World>{})), Displacement<Rest>>);

static_assert(!applies_to<RestFromWorld, Displacement<Rest>>);
static_assert(!applies_to<RestFromWorld, NullDirection<Rest>>);
static_assert(!applies_to<RestFromWorld, NullDirection<Camera>>);
static_assert(!applies_to<RestFromWorld, Event<World>>, "a Lorentz transformation moves no origin");
static_assert(!applies_to<RestFromWorld, Vec3>, "a bare vector is in no frame");
static_assert(!assigns<RestFromWorld, WorldFromRest>, "the inverse is another transformation");
static_assert(!multiplies<WorldFromRest, RestFromWorld>, "a composition of boosts is not a boost");
static_assert(!multiplies<RestFromWorld, RestFromWorld>);
static_assert(!multiplies<LorentzTransform<Camera, World>, WorldFromRest>);
static_assert(!multiplies<RestFromWorld, Displacement<World>>, "a transformation is applied, not multiplied");

// Doppler factors chain like the frames they name.
using CameraRest = DopplerFactor<Camera, Rest>;
using RestSource = DopplerFactor<Rest, Source>;
static_assert(multiplies<CameraRest, RestSource>);
static_assert(std::same_as<decltype(CameraRest{} * RestSource{}), DopplerFactor<Camera, Source>>);

static_assert(!multiplies<RestSource, CameraRest>, "the wrong way round");
static_assert(!multiplies<CameraRest, CameraRest>);
static_assert(!multiplies<CameraRest, double>);
static_assert(!assigns<CameraRest, double>);
static_assert(!assigns<CameraRest, DopplerFactor<Rest, Camera>>, "the inverse is another factor");
static_assert(!std::convertible_to<CameraRest, double>);

// Radiance goes to another frame by carry() alone.
template <class Light, class Factor>
concept carries = requires(Light light, Factor d, BrightnessSwitches on) {
  carry(light, d, 1.0, on);
};
static_assert(carries<Radiance<Rest>, CameraRest>);
static_assert(std::same_as<decltype(carry(Radiance<Rest>{}, CameraRest{}, 1.0, {})), Radiance<Camera>>);

static_assert(!adds<Radiance<Rest>, Radiance<Camera>>);
static_assert(!assigns<Radiance<Camera>, Radiance<Rest>>);
static_assert(!carries<Radiance<Camera>, CameraRest>);
static_assert(!carries<Radiance<Rest>, DopplerFactor<Rest, Camera>>);
static_assert(!multiplies<CameraRest, Radiance<Rest>>, "the power of D is carry()'s business");

// The tags cost nothing: a vector in a frame is as large as its numbers.
static_assert(sizeof(Event<World>) == 4 * sizeof(double));
static_assert(sizeof(Displacement<World>) == 4 * sizeof(double));
static_assert(sizeof(DopplerFactor<Camera, Rest>) == sizeof(double));
static_assert(std::is_trivially_copyable_v<Event<World>> &&
              std::is_trivially_copyable_v<NullDirection<Rest>>);

// The one thing left for run time: that chained factors multiply.
TEST(IllFormed, ChainedDopplerFactorsMultiply) {
  const DopplerFactor<Camera, Source> chained = CameraRest{0.5} * RestSource{3.0};
  EXPECT_EQ(chained.value, 1.5);
}

}  // namespace
}  // namespace backlight
