/* Status and message: what a call of corot returns, how a function of your own passes it on, and
   where the reason of a failure is found. Needs corot::core. */
#include <corot/base.h>
#include <corot/mesh.h>
#include <stdio.h>
#include <string.h>

/* A function of your own may return a corot_status, too. COROT_TRY returns from it at once with the
   status of a call that fails; corot_fail leaves a message and returns the status it is given. */
static corot_status count_tets(const char *path, int *ntet) {
  corot_mesh *mesh;
  if (!*path) return corot_fail(COROT_EINVAL, "the path of the mesh has %zu letters", strlen(path));
  COROT_TRY(corot_mesh_read(path, &mesh));
  *ntet = mesh->ntet;
  corot_mesh_destroy(mesh);
  return COROT_OK;
}

int main(void) {
  int ntet = -1; /* outputs are set on success only */
  corot_status status = count_tets("/nowhere/bar.msh", &ntet);
  printf("missing file: %s, %d tets: %s\n", status == COROT_EIO ? "COROT_EIO" : "?", ntet,
         corot_error());
  status = count_tets("", &ntet);
  printf("no path: %s, %d tets: %s\n", status == COROT_EINVAL ? "COROT_EINVAL" : "?", ntet,
         corot_error());
  printf("the library is %s of the headers\n",
         strcmp(corot_version(), COROT_VERSION) == 0 ? "that" : "not that");
}
