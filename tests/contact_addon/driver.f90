! The same calls as driver.c, by the Fortran module of the interface:
!   driver basic DIR | driver wheels RAIL WHEEL POSITIONS DIR
! It prints what driver.c prints under the same names, of the numbers that both have.
module shared
  use contact_addon
  implicit none
  integer, parameter :: dp = c_double
contains
  subroutine fail(what)
    character(*), intent(in) :: what
    write (0, '(a)') what
    stop 1
  end subroutine fail

  subroutine show(name, value)
    character(*), intent(in) :: name
    real(dp), intent(in) :: value
    write (*, '(a,1x,es24.16e3)') trim(name), value
  end subroutine show

  subroutine begin(folder)
    character(*), intent(in) :: folder
    integer(c_int) :: version(1), error(1)
    call cntc_setfileunits([3], [11, 12, 13])
    call cntc_initializefirst(version, error, [0], folder, ' ', 'fortran', [len(folder)], [1], [7])
    if (version(1) < 2500 .or. error(1) /= 0) call fail('initializefirst')
    call cntc_setglobalflags([2], [2000, 2003], [2, 1])
  end subroutine begin

  subroutine print_patch(ire, icp, name)
    integer(c_int), intent(in) :: ire, icp
    character(*), intent(in) :: name
    integer(c_int) :: r(1), c(1), mx(1), my(1)
    real(dp) :: a(1), b(1), d(1), e(1)
    real(dp), allocatable :: pn(:), px(:), py(:)
    r = ire
    c = icp
    call cntc_getpenetration(r, c, a)
    call show(name//'.pen', a(1))
    call cntc_getcreepages(r, c, a, b, d)
    call show(name//'.cksi', a(1))
    call show(name//'.ceta', b(1))
    call show(name//'.cphi', d(1))
    call cntc_getcontactforces(r, c, a, b, d, e)
    call show(name//'.fn', a(1))
    call show(name//'.fx', b(1))
    call show(name//'.fy', d(1))
    call show(name//'.mz', e(1))
    call cntc_getcontactpatchareas(r, c, a, b, d)
    call show(name//'.area', a(1))
    call show(name//'.adhesion', b(1))
    call show(name//'.slip', d(1))
    call cntc_getmaximumpressure(r, c, a)
    call show(name//'.pmax', a(1))
    call cntc_getmaximumtraction(r, c, a)
    call show(name//'.tmax', a(1))
    call cntc_getgriddiscretization(r, c, d, e)
    call show(name//'.dx', d(1))
    call cntc_getnumelements(r, c, mx, my)
    call show(name//'.mx', real(mx(1), dp))
    call show(name//'.my', real(my(1), dp))
    allocate (pn(mx(1)*my(1)), px(mx(1)*my(1)), py(mx(1)*my(1)))
    call cntc_gettractions(r, c, [mx(1)*my(1)], pn, px, py)
    call show(name//'.sum_pn', sum(pn)*d(1)*e(1))
    call cntc_getcalculationtime(r, c, a, b)
    if (.not. b(1) > 0) call fail('no time')
  end subroutine print_patch

  integer function solved(ire, icp)
    integer(c_int), intent(in) :: ire, icp
    integer(c_int) :: error(1)
    call cntc_calculate([ire], [icp], error)
    solved = error(1)
  end function solved

  subroutine set_up_basic(ire)
    integer(c_int), intent(in) :: ire
    integer(c_int), parameter :: icp = 2
    integer :: i, j
    real(dp) :: h(23, 33), x, y
    call cntc_setflags([ire], [icp], [4], [1933, 1970, 1972, 1983], [1935, 2, 3, 0])
    call cntc_setmetadata([ire], [icp], [2], [2011, 2012], [0.5_dp, 1.25_dp])
    call cntc_setreferencevelocity([ire], [icp], [24.0_dp])
    call cntc_setrollingstepsize([ire], [icp], [0.0_dp], [0.0005_dp])
    call cntc_setcreepages([ire], [icp], [0.001_dp], [0.0_dp], [0.4_dp])
    if (ire == 1) then
      call cntc_setmaterialparameters([ire], [icp], [0], [4], [0.28_dp, 0.28_dp, 82e9_dp, 82e9_dp])
      call cntc_setfrictionmethod([ire], [icp], [0], [2], [0.3_dp, 0.3_dp])
      call cntc_setpenetration([ire], [icp], [5e-5_dp])
      call cntc_sethertzcontact([ire], [icp], [-3], [5], &
        [21.0_dp, 33.0_dp, 0.00425_dp, 0.007_dp, 21.0_dp/17.0_dp])
      call cntc_setsolverflags([ire], [icp], [0], [4], [999, 30, 30, 1], [1], [1e-4_dp])
    else
      call cntc_setfrictionmethod([ire], [icp], [5], [3], &
        [0.3_dp, 0.6_dp, 0.69314718055994531_dp/1.25_dp])
      call cntc_setmaterialparameters([ire], [icp], [4], [8], &
        [0.28_dp, 0.28_dp, 82e9_dp, 82e9_dp, 100e6_dp, 1e-5_dp, 0.0_dp, 0.0_dp])
      call cntc_setnormalforce([ire], [icp], [42083.0_dp])
      call cntc_setpotcontact([ire], [icp], [1], [6], &
        [23.0_dp, 33.0_dp, -0.00725_dp, -0.00725_dp, 0.0005_dp, 0.0005_dp])
      do j = 1, 33
        do i = 1, 23
          x = -0.00725_dp + 0.0005_dp*(i - 0.5_dp)
          y = -0.00725_dp + 0.0005_dp*(j - 0.5_dp)
          h(i, j) = 1.214_dp*x*x + 0.5731_dp*y*y
        end do
      end do
      call cntc_setundeformeddistc([ire], [icp], [9], [23*33], reshape(h, [23*33]))
    end if
  end subroutine set_up_basic

  subroutine basic(folder)
    character(*), intent(in) :: folder
    integer(c_int) :: ire, version(1), error(1)
    call begin(folder)
    do ire = 1, 2
      call cntc_initialize([ire], [3], version, error, ' ', [1])
      if (error(1) /= 0) call fail('initialize')
      call set_up_basic(ire)
    end do
    call show('first.error', real(solved(1, 2), dp))
    call print_patch(1, 2, 'first')
    call show('second.error', real(solved(2, 2), dp))
    call print_patch(2, 2, 'second')
    call cntc_setnormalforce([2], [2], [19563.0_dp])
    call cntc_setcreepages([2], [2], [0.001_dp], [0.0_dp], [-0.3_dp])
    call show('third.error', real(solved(2, 2), dp))
    call print_patch(2, 2, 'third')
    call cntc_finalize([2])
    call show('fourth.error', real(solved(1, 2), dp))
    call print_patch(1, 2, 'fourth')
    call cntc_finalize([1])
  end subroutine basic

  subroutine set_up_wheel(ire, rail, wheel)
    integer(c_int), intent(in) :: ire
    character(*), intent(in) :: rail, wheel
    integer(c_int), parameter :: all = -1
    integer(c_int) :: version(1), error(1)
    real(dp) :: track(11)
    call cntc_initialize([ire], [1], version, error, ' ', [1])
    if (error(1) /= 0) call fail('initialize')
    call cntc_setflags([ire], [all], [6], [1933, 1967, 1972, 1970, 1977, 1993], &
      [1934, ire - 1, 3, 2, 2, 20000])
    call cntc_setsolverflags([ire], [all], [0], [4], [999, 100, 30, 1], [1], [1e-5_dp])
    call cntc_setmaterialparameters([ire], [all], [0], [4], [0.28_dp, 0.28_dp, 82e3_dp, 82e3_dp])
    call cntc_setfrictionmethod([ire], [all], [0], [2], [0.3_dp, 0.3_dp])
    call cntc_setpotcontact([ire], [all], [-1], [5], &
      [0.2_dp, 0.2_dp, 1.5707963267948966_dp, 8.0_dp, 4.0_dp])
    call cntc_setrollingstepsize([ire], [all], [0.0_dp], [1.0_dp])
    track = 0
    track(1) = 14
    track(3) = 1435
    call cntc_settrackdimensions([ire], [3], [11], track)
    call cntc_setprofileinputfname([ire], rail, [len(rail)], [6], [0, 0, 0, 0, 0, 0], [2], [1.0_dp, 0.0_dp])
    call cntc_setwheelsetdimensions([ire], [3], [3], [1360.0_dp, -70.0_dp, 460.0_dp])
    call cntc_setprofileinputfname([ire], wheel, [len(wheel)], [6], [1, 0, 0, 0, 0, 0], [2], [1.0_dp, 0.0_dp])
    call subs_addblock([ire], [all], [1], [9], [1], [1], [3], [0.0_dp], [0.0_dp], [0.5_dp, 1.0_dp, 2.0_dp])
  end subroutine set_up_wheel

  subroutine wheels(rail, wheel, positions, folder)
    character(*), intent(in) :: rail, wheel, positions, folder
    integer(c_int), parameter :: all = -1
    integer(c_int) :: ire, icp, patches(1), error(1), nx(1), ny(1), nz(1)
    integer :: k, i, unit, status
    real(dp) :: at(4), force(24), place(38), values(12)
    character(40) :: name
    call begin(folder)
    do ire = 1, 2
      call set_up_wheel(ire, rail, wheel)
    end do
    open (newunit=unit, file=positions, action='read')
    do k = 0, 999
      read (unit, *, iostat=status) at
      if (status /= 0) exit
      do ire = 1, 2
        call cntc_setwheelsetposition([ire], [2], [6], [0.0_dp, at(1), 0.0_dp, at(2), at(3), 0.0_dp])
        call cntc_setwheelsetvelocity([ire], [2], [6], &
          [2000.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, 0.0_dp, at(4)])
        call cntc_setverticalforce([ire], [10000.0_dp])
        write (name, '(a,i0)') trim(merge('left ', 'right', ire == 1)), k
        call show(trim(name)//'.error', real(solved(ire, all), dp))
        call cntc_getglobalforces([ire], [all], [24], force)
        do i = 0, 23
          call show_part(trim(name)//'.force', i, force(i + 1))
        end do
        call cntc_getnumcontactpatches([ire], patches)
        call show(trim(name)//'.patches', real(patches(1), dp))
        do icp = 1, patches(1)
          write (name, '(a,i0,a,i0)') trim(merge('left ', 'right', ire == 1)), k, '.', icp
          call cntc_getcontactlocation([ire], [icp], [38], place)
          do i = 0, 37
            call show_part(trim(name)//'.place', i, place(i + 1))
          end do
          call print_patch(ire, icp, trim(name))
        end do
        if (ire == 2 .and. k == 11) then
          call subs_calculate([ire], [all], error)
          call subs_getblocksize([ire], [1], [1], nx, ny, nz)
          call show('block.size', real(nx(1)*ny(1)*nz(1), dp))
          call subs_getresults([ire], [1], [1], [3], [4], [1, 2, 3, 8], values)
          do i = 0, 11
            call show_part('block.value', i, values(i + 1))
          end do
        end if
        if (k == 0) then ! what was set holds on
          call cntc_setflags([ire], [all], [2], [1977, 1978], [1, 1])
          call cntc_setsolverflags([ire], [all], [1], [0], [0], [0], [0.0_dp])
          call cntc_setfrictionmethod([ire], [all], [1], [0], [0.0_dp])
          call cntc_settrackdimensions([ire], [0], [0], [0.0_dp])
          call cntc_setwheelsetdimensions([ire], [0], [0], [0.0_dp])
        end if
      end do
    end do
    close (unit)
    call cntc_finalizelast()
  end subroutine wheels

  subroutine show_part(name, i, value)
    character(*), intent(in) :: name
    integer, intent(in) :: i
    real(dp), intent(in) :: value
    character(60) :: whole
    write (whole, '(a,i0)') name, i
    call show(whole, value)
  end subroutine show_part
end module shared

program driver
  use shared
  implicit none
  character(1000) :: word(5)
  integer :: i
  do i = 1, 5
    call get_command_argument(i, word(i))
  end do
  if (word(1) == 'basic') then
    call basic(trim(word(2)))
  else if (word(1) == 'wheels') then
    call wheels(trim(word(2)), trim(word(3)), trim(word(4)), trim(word(5)))
  else
    stop 2
  end if
end program driver
