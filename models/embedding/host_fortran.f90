! A host in Fortran, by iso_c_binding: the model is made in C (bar_model.c), and integrated here, by the
! classical Runge-Kutta method at a constant step. Needs corot::core alone.
module corot
  use, intrinsic :: iso_c_binding
  implicit none
  interface
    function bar_model() bind(c)
      import
      type(c_ptr) :: bar_model
    end function
    integer(c_int) function corot_state_create(model, state) bind(c)
      import
      type(c_ptr), value :: model
      type(c_ptr) :: state
    end function
    integer(c_int) function corot_model_ndof(model) bind(c)
      import
      type(c_ptr), value :: model
    end function
    integer(c_int) function corot_rhs(model, state, t, y, ydot) bind(c)
      import
      type(c_ptr), value :: model, state
      real(c_double), value :: t
      real(c_double), intent(in) :: y(*)
      real(c_double), intent(out) :: ydot(*)
    end function
    type(c_ptr) function corot_model_mesh(model) bind(c)
      import
      type(c_ptr), value :: model
    end function
    integer(c_int) function corot_mesh_nearest(mesh, x) bind(c)
      import
      type(c_ptr), value :: mesh
      real(c_double), intent(in) :: x(3)
    end function
    type(c_ptr) function corot_model_dof(model) bind(c) ! [nnode][3], counted from 0
      import
      type(c_ptr), value :: model
    end function
    type(c_ptr) function corot_error() bind(c)
      import
    end function
    subroutine corot_state_destroy(state) bind(c)
      import
      type(c_ptr), value :: state
    end subroutine
    subroutine corot_model_destroy(model) bind(c)
      import
      type(c_ptr), value :: model
    end subroutine
  end interface
contains
  subroutine check(status)
    integer(c_int), intent(in) :: status
    character(kind=c_char), pointer :: text(:)
    if (status == 0) return
    call c_f_pointer(corot_error(), text, [120])
    print '("corot: ", 120a1)', text
    error stop 1
  end subroutine
end module

program host_fortran
  use corot
  implicit none
  type(c_ptr) :: model, state
  integer(c_int), pointer :: dof(:, :)
  integer :: n, node, step
  integer, parameter :: nstep = 4000
  real(c_double), parameter :: h = 2d0 / nstep
  real(c_double), allocatable :: y(:), k(:, :)
  real(c_double) :: t

  model = bar_model()
  call check(corot_state_create(model, state))
  n = 2 * corot_model_ndof(model)
  allocate (y(n), k(n, 4))
  y = 0 ! (u, v), at rest
  do step = 1, nstep
    t = (step - 1) * h
    call check(corot_rhs(model, state, t, y, k(:, 1)))
    call check(corot_rhs(model, state, t + h / 2, y + h / 2 * k(:, 1), k(:, 2)))
    call check(corot_rhs(model, state, t + h / 2, y + h / 2 * k(:, 2), k(:, 3)))
    call check(corot_rhs(model, state, t + h, y + h * k(:, 3), k(:, 4)))
    y = y + h / 6 * (k(:, 1) + 2 * k(:, 2) + 2 * k(:, 3) + k(:, 4))
  end do

  node = corot_mesh_nearest(corot_model_mesh(model), [0.1d0, 0.1d0, 0.6d0])
  call c_f_pointer(corot_model_dof(model), dof, [3, node + 1])
  print '(3g22.13)', y(dof(:, node + 1) + 1)
  call corot_state_destroy(state)
  call corot_model_destroy(model)
  deallocate (y, k) ! what a main program allocates is not freed at its end
end program
