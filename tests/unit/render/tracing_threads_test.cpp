#include "backlight/render/tracing_threads.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace backlight {
namespace {

Scene empty_scene(double brightness) {
  Scene scene;
  scene.frames.emplace_back();
  scene.film = {70, 50, 2, 0, {"Z"}};
  scene.camera.lens.width = 70;
  scene.camera.lens.height = 50;
  scene.sky.given = scene.sky.emits = true;
  scene.sky.radiance = {Spectrum::d65(), LinearRgb{brightness}};
  return scene;
}

struct Work {
  explicit Work(double brightness) : scene(empty_scene(brightness)), partial(begin_image(scene, settings)) {}

  void start(const std::atomic<bool>& stop) {
    tracing = std::make_unique<ImageTracing>(scene, settings, *partial, stop, nullptr);
  }

  Scene scene;
  RenderSettings settings{.threads = 3};
  std::unique_ptr<PartialImage> partial;
  std::unique_ptr<ImageTracing> tracing;
};

bool same_bits(const Image& a, const Image& b) {
  for (std::size_t channel = 0; channel < a.channel_count(); ++channel) {
    const auto x = a.plane(channel);
    if (std::memcmp(x.data(), b.plane(channel).data(), x.size_bytes()) != 0) return false;
  }
  return true;
}

TEST(TracingThreads, TraceWhatRenderImageDoes) {
  const std::atomic<bool> never{false};
  TracingThreads threads(3, never);
  std::vector<std::unique_ptr<Work>> all;
  for (int i = 0; i < 20; ++i) {
    all.push_back(std::make_unique<Work>(i + 1.0));
    all.back()->start(never);
    threads.begin(*all.back()->tracing);
  }
  for (const auto& work : all) {
    EXPECT_GE(threads.finish(), 0.0);
    EXPECT_TRUE(work->partial->is_complete());
    const auto alone = render_image(work->scene, {}, never, nullptr);
    ASSERT_TRUE(alone);
    EXPECT_TRUE(same_bits(alone->image, work->partial->whole()));
    EXPECT_EQ(work->tracing->statistics().rays.primary, alone->statistics.rays.primary);
  }
  EXPECT_FALSE(threads.first_is_done());
  const TracingTime time = threads.time();
  EXPECT_EQ(time.threads, 3);
  EXPECT_GT(time.traced, 0.0);
  EXPECT_LE(time.traced, time.seconds * 3);
}

// A signal pauses all images; those that were put aside go on in their order.
TEST(TracingThreads, GoOnAfterAPause) {
  std::atomic<bool> pause{true};
  TracingThreads threads(2, pause);
  Work first(1.0);
  Work second(2.0);
  for (Work* work : {&first, &second}) {
    work->start(pause);
    threads.begin(*work->tracing);
  }
  threads.wait_for_tail();
  threads.finish();
  EXPECT_FALSE(first.partial->has_any());
  pause.store(false);
  threads.go_on_with(*first.tracing);
  threads.finish();
  EXPECT_TRUE(first.partial->is_complete());
  threads.finish();
  if (!second.partial->is_complete()) {  // it had been looked at during the pause
    threads.go_on_with(*second.tracing);
    threads.finish();
  }
  EXPECT_TRUE(second.partial->is_complete());
}

// A lamp whose strength cannot be evaluated: such an exception must not end a thread, nor the other images.
TEST(TracingThreads, RethrowWhatATileThrows) {
  const std::atomic<bool> never{false};
  TracingThreads threads(2, never);
  Work bad(1.0);
  SurfaceSet surfaces;
  surfaces.add(plane(), Placement{Vec3{0.0, -1.0, 0.0}, Vec3{0.0}, Vec3{1.0}});
  surfaces.build();
  bad.scene.frames[0].surfaces = std::make_shared<const SurfaceSet>(std::move(surfaces));
  bad.scene.frames[0].object_of_surface = std::vector<int>{0};
  bad.scene.objects = std::vector<Object>(1);
  bad.scene.materials = std::vector<Material>(1);
  Light lamp;
  lamp.kind = LightKind::ambient;
  lamp.flickers = true;
  lamp.strength_of_time = std::get<Expression>(Expression::parse("t + frame", {"t", "frame"}));
  bad.scene.lights.push_back(lamp);
  Work good(1.0);
  for (Work* work : {&bad, &good}) {
    work->start(never);
    threads.begin(*work->tracing);
  }
  EXPECT_THROW(threads.finish(), PixelFailure);
  threads.finish();
  EXPECT_TRUE(good.partial->is_complete());
}

TEST(TracingTime, LostIsTheTimeWithoutATile) {
  EXPECT_DOUBLE_EQ((TracingTime{2.0, 3.0, 2}).lost(), 0.25);
  EXPECT_DOUBLE_EQ((TracingTime{2.0, 4.0, 2}).lost(), 0.0);
  EXPECT_DOUBLE_EQ((TracingTime{0.0, 0.0, 2}).lost(), 0.0);
}

}  // namespace
}  // namespace backlight
