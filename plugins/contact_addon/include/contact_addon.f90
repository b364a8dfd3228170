! The calls of contact_addon.h for Fortran, made from it by fortran.py. Scalars, arrays
! alike go by reference; arrays have any length.
module contact_addon
  use, intrinsic :: iso_c_binding
  implicit none
  interface
    subroutine cntc_setfileunits( &
      count, units) bind(c)
      import
      integer(c_int) :: count(*)
      integer(c_int) :: units(*)
    end subroutine cntc_setfileunits
    subroutine cntc_initializefirst( &
      ifcver, ierror, ioutput, wrkdir, outdir, expnam, &
      len_wrkdir, len_outdir, len_expnam) bind(c)
      import
      integer(c_int) :: ifcver(*)
      integer(c_int) :: ierror(*)
      integer(c_int) :: ioutput(*)
      character(kind=c_char) :: wrkdir(*)
      character(kind=c_char) :: outdir(*)
      character(kind=c_char) :: expnam(*)
      integer(c_int) :: len_wrkdir(*)
      integer(c_int) :: len_outdir(*)
      integer(c_int) :: len_expnam(*)
    end subroutine cntc_initializefirst
    subroutine cntc_initializefirst_new( &
      ifcver, ierror, ioutput, wrkdir, outdir, expnam, &
      len_wrkdir, len_outdir, len_expnam) bind(c)
      import
      integer(c_int) :: ifcver(*)
      integer(c_int) :: ierror(*)
      integer(c_int) :: ioutput(*)
      character(kind=c_char) :: wrkdir(*)
      character(kind=c_char) :: outdir(*)
      character(kind=c_char) :: expnam(*)
      integer(c_int) :: len_wrkdir(*)
      integer(c_int) :: len_outdir(*)
      integer(c_int) :: len_expnam(*)
    end subroutine cntc_initializefirst_new
    subroutine cntc_initialize( &
      ire, imodul, ifcver, ierror, outdir, len_outdir) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: imodul(*)
      integer(c_int) :: ifcver(*)
      integer(c_int) :: ierror(*)
      character(kind=c_char) :: outdir(*)
      integer(c_int) :: len_outdir(*)
    end subroutine cntc_initialize
    subroutine cntc_setglobalflags( &
      count, codes, values) bind(c)
      import
      integer(c_int) :: count(*)
      integer(c_int) :: codes(*)
      integer(c_int) :: values(*)
    end subroutine cntc_setglobalflags
    subroutine cntc_getmaxnumthreads( &
      count) bind(c)
      import
      integer(c_int) :: count(*)
    end subroutine cntc_getmaxnumthreads
    subroutine cntc_finalize( &
      ire) bind(c)
      import
      integer(c_int) :: ire(*)
    end subroutine cntc_finalize
    subroutine cntc_finalizelast() bind(c)
      import
    end subroutine cntc_finalizelast
    subroutine cntc_readinpfile( &
      ire, type, name, len_name, ierror) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: type(*)
      character(kind=c_char) :: name(*)
      integer(c_int) :: len_name(*)
      integer(c_int) :: ierror(*)
    end subroutine cntc_readinpfile
    subroutine cntc_setflags( &
      ire, icp, count, codes, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      integer(c_int) :: codes(*)
      integer(c_int) :: values(*)
    end subroutine cntc_setflags
    subroutine cntc_setmetadata( &
      ire, icp, count, codes, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      integer(c_int) :: codes(*)
      real(c_double) :: values(*)
    end subroutine cntc_setmetadata
    subroutine cntc_setsolverflags( &
      ire, icp, gdigit, nints, ints, nreals, &
      reals) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: gdigit(*)
      integer(c_int) :: nints(*)
      integer(c_int) :: ints(*)
      integer(c_int) :: nreals(*)
      real(c_double) :: reals(*)
    end subroutine cntc_setsolverflags
    subroutine cntc_setmaterialparameters( &
      ire, icp, mdigit, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: mdigit(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setmaterialparameters
    subroutine cntc_settemperaturedata( &
      ire, icp, hdigit, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: hdigit(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_settemperaturedata
    subroutine cntc_settimestep( &
      ire, icp, dt) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: dt(*)
    end subroutine cntc_settimestep
    subroutine cntc_setreferencevelocity( &
      ire, icp, veloc) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: veloc(*)
    end subroutine cntc_setreferencevelocity
    subroutine cntc_setrollingstepsize( &
      ire, icp, chi, dq) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: chi(*)
      real(c_double) :: dq(*)
    end subroutine cntc_setrollingstepsize
    subroutine cntc_setfrictionmethod( &
      ire, icp, method, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: method(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setfrictionmethod
    subroutine cntc_sethertzcontact( &
      ire, icp, ipotcn, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: ipotcn(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_sethertzcontact
    subroutine cntc_setpotcontact( &
      ire, icp, ipotcn, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: ipotcn(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setpotcontact
    subroutine cntc_setverticalforce( &
      ire, fz) bind(c)
      import
      integer(c_int) :: ire(*)
      real(c_double) :: fz(*)
    end subroutine cntc_setverticalforce
    subroutine cntc_setpenetration( &
      ire, icp, pen) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: pen(*)
    end subroutine cntc_setpenetration
    subroutine cntc_setnormalforce( &
      ire, icp, fn) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: fn(*)
    end subroutine cntc_setnormalforce
    subroutine cntc_setundeformeddistc( &
      ire, icp, ibase, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: ibase(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setundeformeddistc
    subroutine cntc_setcreepages( &
      ire, icp, vx, vy, phi) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: vx(*)
      real(c_double) :: vy(*)
      real(c_double) :: phi(*)
    end subroutine cntc_setcreepages
    subroutine cntc_setextrarigidslip( &
      ire, icp, count, wx, wy) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: wx(*)
      real(c_double) :: wy(*)
    end subroutine cntc_setextrarigidslip
    subroutine cntc_settangentialforces( &
      ire, icp, fx, fy) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: fx(*)
      real(c_double) :: fy(*)
    end subroutine cntc_settangentialforces
    subroutine cntc_setprofileinputfname( &
      ire, name, len_name, nints, ints, nreals, &
      reals) bind(c)
      import
      integer(c_int) :: ire(*)
      character(kind=c_char) :: name(*)
      integer(c_int) :: len_name(*)
      integer(c_int) :: nints(*)
      integer(c_int) :: ints(*)
      integer(c_int) :: nreals(*)
      real(c_double) :: reals(*)
    end subroutine cntc_setprofileinputfname
    subroutine cntc_setprofileinputvalues( &
      ire, npoint, values, nints, ints, nreals, &
      reals) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: npoint(*)
      real(c_double) :: values(*)
      integer(c_int) :: nints(*)
      integer(c_int) :: ints(*)
      integer(c_int) :: nreals(*)
      real(c_double) :: reals(*)
    end subroutine cntc_setprofileinputvalues
    subroutine cntc_settrackdimensions( &
      ire, ztrack, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: ztrack(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_settrackdimensions
    subroutine cntc_setwheelsetdimensions( &
      ire, ewheel, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: ewheel(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setwheelsetdimensions
    subroutine cntc_setwheelsetposition( &
      ire, ewheel, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: ewheel(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setwheelsetposition
    subroutine cntc_setwheelsetvelocity( &
      ire, ewheel, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: ewheel(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setwheelsetvelocity
    subroutine cntc_setwheelsetflexibility( &
      ire, ewheel, count, params) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: ewheel(*)
      integer(c_int) :: count(*)
      real(c_double) :: params(*)
    end subroutine cntc_setwheelsetflexibility
    subroutine subs_addblock( &
      ire, icp, iblk, isubs, nx, ny, &
      nz, x, y, z) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: iblk(*)
      integer(c_int) :: isubs(*)
      integer(c_int) :: nx(*)
      integer(c_int) :: ny(*)
      integer(c_int) :: nz(*)
      real(c_double) :: x(*)
      real(c_double) :: y(*)
      real(c_double) :: z(*)
    end subroutine subs_addblock
    subroutine cntc_calculate( &
      ire, icp, ierror) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: ierror(*)
    end subroutine cntc_calculate
    subroutine cntc_calculate1( &
      ire, ierror) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: ierror(*)
    end subroutine cntc_calculate1
    subroutine cntc_calculate3( &
      ire, icp, ierror) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: ierror(*)
    end subroutine cntc_calculate3
    subroutine subs_calculate( &
      ire, icp, ierror) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: ierror(*)
    end subroutine subs_calculate
    subroutine cntc_getflags( &
      ire, icp, count, codes, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      integer(c_int) :: codes(*)
      integer(c_int) :: values(*)
    end subroutine cntc_getflags
    subroutine cntc_getparameters( &
      ire, icp, task, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: task(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getparameters
    subroutine cntc_getprofilevalues( &
      ire, task, nints, ints, nreals, reals, &
      count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: task(*)
      integer(c_int) :: nints(*)
      integer(c_int) :: ints(*)
      integer(c_int) :: nreals(*)
      real(c_double) :: reals(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getprofilevalues
    subroutine cntc_getprofilevalues_new( &
      ire, task, nints, ints, nreals, reals, &
      count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: task(*)
      integer(c_int) :: nints(*)
      integer(c_int) :: ints(*)
      integer(c_int) :: nreals(*)
      real(c_double) :: reals(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getprofilevalues_new
    subroutine cntc_getwheelsetposition( &
      ire, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getwheelsetposition
    subroutine cntc_getwheelsetvelocity( &
      ire, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getwheelsetvelocity
    subroutine cntc_getnumcontactpatches( &
      ire, count) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: count(*)
    end subroutine cntc_getnumcontactpatches
    subroutine cntc_getcontactlocation( &
      ire, icp, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getcontactlocation
    subroutine cntc_getglobalforces( &
      ire, icp, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getglobalforces
    subroutine cntc_getreferencevelocity( &
      ire, icp, veloc) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: veloc(*)
    end subroutine cntc_getreferencevelocity
    subroutine cntc_gethertzcontact( &
      ire, icp, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_gethertzcontact
    subroutine cntc_getnumelements( &
      ire, icp, mx, my) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: mx(*)
      integer(c_int) :: my(*)
    end subroutine cntc_getnumelements
    subroutine cntc_getgriddiscretization( &
      ire, icp, dx, dy) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: dx(*)
      real(c_double) :: dy(*)
    end subroutine cntc_getgriddiscretization
    subroutine cntc_getpotcontact( &
      ire, icp, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getpotcontact
    subroutine cntc_getpenetration( &
      ire, icp, pen) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: pen(*)
    end subroutine cntc_getpenetration
    subroutine cntc_getcreepages( &
      ire, icp, vx, vy, phi) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: vx(*)
      real(c_double) :: vy(*)
      real(c_double) :: phi(*)
    end subroutine cntc_getcreepages
    subroutine cntc_getcontactforces( &
      ire, icp, fn, tx, ty, mz) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: fn(*)
      real(c_double) :: tx(*)
      real(c_double) :: ty(*)
      real(c_double) :: mz(*)
    end subroutine cntc_getcontactforces
    subroutine cntc_getcontactpatchareas( &
      ire, icp, contact, adhesion, slip) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: contact(*)
      real(c_double) :: adhesion(*)
      real(c_double) :: slip(*)
    end subroutine cntc_getcontactpatchareas
    subroutine cntc_getelementdivision( &
      ire, icp, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      integer(c_int) :: values(*)
    end subroutine cntc_getelementdivision
    subroutine cntc_getmaximumpressure( &
      ire, icp, value) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: value(*)
    end subroutine cntc_getmaximumpressure
    subroutine cntc_getmaximumtraction( &
      ire, icp, value) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: value(*)
    end subroutine cntc_getmaximumtraction
    subroutine cntc_getmaximumtemperature( &
      ire, icp, body1, body2) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: body1(*)
      real(c_double) :: body2(*)
    end subroutine cntc_getmaximumtemperature
    subroutine cntc_getfielddata( &
      ire, icp, field, count, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: field(*)
      integer(c_int) :: count(*)
      real(c_double) :: values(*)
    end subroutine cntc_getfielddata
    subroutine cntc_gettractions( &
      ire, icp, count, pn, px, py) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: pn(*)
      real(c_double) :: px(*)
      real(c_double) :: py(*)
    end subroutine cntc_gettractions
    subroutine cntc_getmicroslip( &
      ire, icp, count, sx, sy) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: sx(*)
      real(c_double) :: sy(*)
    end subroutine cntc_getmicroslip
    subroutine cntc_getdisplacements( &
      ire, icp, count, un, ux, uy) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: count(*)
      real(c_double) :: un(*)
      real(c_double) :: ux(*)
      real(c_double) :: uy(*)
    end subroutine cntc_getdisplacements
    subroutine cntc_getsensitivities( &
      ire, icp, nout, nin, values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: nout(*)
      integer(c_int) :: nin(*)
      real(c_double) :: values(*)
    end subroutine cntc_getsensitivities
    subroutine cntc_getcalculationtime( &
      ire, icp, cpu, wall) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      real(c_double) :: cpu(*)
      real(c_double) :: wall(*)
    end subroutine cntc_getcalculationtime
    subroutine cntc_resetcalculationtime( &
      ire, icp) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
    end subroutine cntc_resetcalculationtime
    subroutine subs_getblocksize( &
      ire, icp, iblk, nx, ny, nz) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: iblk(*)
      integer(c_int) :: nx(*)
      integer(c_int) :: ny(*)
      integer(c_int) :: nz(*)
    end subroutine subs_getblocksize
    subroutine subs_getresults( &
      ire, icp, iblk, count, ncolumn, columns, &
      values) bind(c)
      import
      integer(c_int) :: ire(*)
      integer(c_int) :: icp(*)
      integer(c_int) :: iblk(*)
      integer(c_int) :: count(*)
      integer(c_int) :: ncolumn(*)
      integer(c_int) :: columns(*)
      real(c_double) :: values(*)
    end subroutine subs_getresults
  end interface
end module contact_addon
