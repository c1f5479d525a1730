// A host in C++17: corot's objects in unique_ptr, so that whatever happens they are destroyed in the
// right order, and statuses as exceptions. The headers are C that C++ reads as it is.
#include <corot/sun_cvode.h>

#include <memory>
#include <stdexcept>

#include "bar.h"
#include "sun.h"

namespace {

void must(corot_status status) {
  if (status != COROT_OK) throw std::runtime_error(corot_error());
}

// owned<T, destroy>: a T * that is destroyed by `destroy`.
template <auto destroy>
struct deleter {
  template <class T>
  void operator()(T *object) const {
    destroy(object);
  }
};
template <class T, auto destroy>
using owned = std::unique_ptr<T, deleter<destroy>>;

// What create(&object) makes.
template <class Owned, class Create>
Owned make(Create create) {
  typename Owned::pointer object = nullptr;
  must(create(&object));
  return Owned(object);
}

using model_ptr = owned<corot_model, corot_model_destroy>;
using state_ptr = owned<corot_state, corot_state_destroy>;
using pencil_ptr = owned<corot_pencil, corot_pencil_destroy>;

void run() {
  model_ptr model(bar_create());
  auto state = make<state_ptr>([&](auto s) { return corot_state_create(model.get(), s); });
  auto pencil = make<pencil_ptr>(
      [&](auto p) { return corot_pencil_create(model.get(), state.get(), nullptr, p); });

  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  N_Vector y = zeros(2 * corot_model_ndof(model.get()), ctx);
  void *cvode = CVodeCreate(CV_BDF, ctx);
  SUN(CVodeInit(cvode, corot_sun_rhs, 0, y));

  corot_sun_host host = {};
  corot_sun_data data = {};
  data.model = model.get(), data.state = state.get(), data.rtol = 1e-7;
  must(corot_sun_cvode_open(&host, cvode, pencil.get(), &data, y));
  must(corot_sun_host_advance(&host, T_END, y));
  bar_print(model.get(), N_VGetArrayPointer(y));

  CVodeFree(&cvode);
  corot_sun_host_close(&host);
  N_VDestroy(y);
  SUNContext_Free(&ctx);
}

}  // namespace

int main() {
  try {
    run();
  } catch (const std::exception &failure) {
    std::fprintf(stderr, "corot: %s\n", failure.what());
    return 1;
  }
}
