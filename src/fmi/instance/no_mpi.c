/* Stand-ins for what SUNDIALS 7, built with Open MPI, names of it. All of it is for communicators
   that are not null, and ours is: none of these functions is called, and of the objects nothing but
   their addresses is ever used. */
#include <stdlib.h>

/* As large as whoever copied one might expect. */
#define OBJECT(name)      \
  extern char name[4096]; \
  char name[4096]
OBJECT(ompi_mpi_comm_null);
OBJECT(ompi_mpi_double);
OBJECT(ompi_mpi_long);

#define FUNCTION(name)       \
  _Noreturn void name(void); \
  void name(void) { abort(); }
FUNCTION(MPI_Abort)
FUNCTION(MPI_Comm_dup)
FUNCTION(MPI_Comm_free)
FUNCTION(MPI_Comm_rank)
FUNCTION(MPI_Comm_size)
FUNCTION(MPI_Op_create)
FUNCTION(MPI_Op_free)
FUNCTION(MPI_Reduce)
FUNCTION(MPI_Type_commit)
FUNCTION(MPI_Type_create_resized)
FUNCTION(MPI_Type_create_struct)
FUNCTION(MPI_Type_free)
FUNCTION(MPI_Type_get_extent)
