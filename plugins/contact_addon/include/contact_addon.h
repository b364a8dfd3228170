/* The calls by which multibody programs use the library of the program CONTACT, answered by
 * Railpatch. Names and arguments are those of that interface; what each does here, and what is
 * refused, stands in docs/contact_users.md.
 *
 * Every argument is a pointer. ire: result element, 1 ... 999; icp: contact patch, 1 ... 9, or -1.
 * Units and signs go by flag 1933 of cntc_setflags. Strings have their length beside them and need
 * no end mark. Different (ire, icp) may be used on different threads at once.
 */
#ifndef CONTACT_ADDON_H
#define CONTACT_ADDON_H

#if defined(_WIN32)
#define CNTC_API __declspec(dllexport)
#else
#define CNTC_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* --- start, end, what holds for all ---------------------------------------------------------- */
CNTC_API void cntc_setfileunits(int *count, int *units);
CNTC_API void cntc_initializefirst(int *ifcver, int *ierror, int *ioutput, const char *wrkdir,
                                   const char *outdir, const char *expnam, int *len_wrkdir,
                                   int *len_outdir, int *len_expnam);
CNTC_API void cntc_initializefirst_new(int *ifcver, int *ierror, int *ioutput, const char *wrkdir,
                                       const char *outdir, const char *expnam, int *len_wrkdir,
                                       int *len_outdir, int *len_expnam);
CNTC_API void cntc_initialize(int *ire, int *imodul, int *ifcver, int *ierror, const char *outdir,
                              int *len_outdir);
CNTC_API void cntc_setglobalflags(int *count, int *codes, int *values);
CNTC_API void cntc_getmaxnumthreads(int *count);
CNTC_API void cntc_finalize(int *ire);
CNTC_API void cntc_finalizelast(void);

/* --- settings --------------------------------------------------------------------------------- */
CNTC_API void cntc_readinpfile(int *ire, int *type, const char *name, int *len_name, int *ierror);
CNTC_API void cntc_setflags(int *ire, int *icp, int *count, int *codes, int *values);
CNTC_API void cntc_setmetadata(int *ire, int *icp, int *count, int *codes, double *values);
CNTC_API void cntc_setsolverflags(int *ire, int *icp, int *gdigit, int *nints, int *ints,
                                  int *nreals, double *reals);
CNTC_API void cntc_setmaterialparameters(int *ire, int *icp, int *mdigit, int *count,
                                         double *params);
CNTC_API void cntc_settemperaturedata(int *ire, int *icp, int *hdigit, int *count, double *params);
CNTC_API void cntc_settimestep(int *ire, int *icp, double *dt);
CNTC_API void cntc_setreferencevelocity(int *ire, int *icp, double *veloc);
CNTC_API void cntc_setrollingstepsize(int *ire, int *icp, double *chi, double *dq);
CNTC_API void cntc_setfrictionmethod(int *ire, int *icp, int *method, int *count, double *params);
CNTC_API void cntc_sethertzcontact(int *ire, int *icp, int *ipotcn, int *count, double *params);
CNTC_API void cntc_setpotcontact(int *ire, int *icp, int *ipotcn, int *count, double *params);
CNTC_API void cntc_setverticalforce(int *ire, double *fz);
CNTC_API void cntc_setpenetration(int *ire, int *icp, double *pen);
CNTC_API void cntc_setnormalforce(int *ire, int *icp, double *fn);
CNTC_API void cntc_setundeformeddistc(int *ire, int *icp, int *ibase, int *count, double *params);
CNTC_API void cntc_setcreepages(int *ire, int *icp, double *vx, double *vy, double *phi);
CNTC_API void cntc_setextrarigidslip(int *ire, int *icp, int *count, double *wx, double *wy);
CNTC_API void cntc_settangentialforces(int *ire, int *icp, double *fx, double *fy);
CNTC_API void cntc_setprofileinputfname(int *ire, const char *name, int *len_name, int *nints,
                                        int *ints, int *nreals, double *reals);
CNTC_API void cntc_setprofileinputvalues(int *ire, int *npoint, double *values, int *nints,
                                         int *ints, int *nreals, double *reals);
CNTC_API void cntc_settrackdimensions(int *ire, int *ztrack, int *count, double *params);
CNTC_API void cntc_setwheelsetdimensions(int *ire, int *ewheel, int *count, double *params);
CNTC_API void cntc_setwheelsetposition(int *ire, int *ewheel, int *count, double *params);
CNTC_API void cntc_setwheelsetvelocity(int *ire, int *ewheel, int *count, double *params);
CNTC_API void cntc_setwheelsetflexibility(int *ire, int *ewheel, int *count, double *params);
CNTC_API void subs_addblock(int *ire, int *icp, int *iblk, int *isubs, int *nx, int *ny, int *nz,
                            double *x, double *y, double *z);

/* --- solving ---------------------------------------------------------------------------------- */
CNTC_API void cntc_calculate(int *ire, int *icp, int *ierror);
CNTC_API void cntc_calculate1(int *ire, int *ierror);
CNTC_API void cntc_calculate3(int *ire, int *icp, int *ierror);
CNTC_API void subs_calculate(int *ire, int *icp, int *ierror);

/* --- results ---------------------------------------------------------------------------------- */
CNTC_API void cntc_getflags(int *ire, int *icp, int *count, int *codes, int *values);
CNTC_API void cntc_getparameters(int *ire, int *icp, int *task, int *count, double *values);
CNTC_API void cntc_getprofilevalues(int *ire, int *task, int *nints, int *ints, int *nreals,
                                    double *reals, int *count, double *values);
CNTC_API void cntc_getprofilevalues_new(int *ire, int *task, int *nints, int *ints, int *nreals,
                                        double *reals, int *count, double *values);
CNTC_API void cntc_getwheelsetposition(int *ire, int *count, double *values);
CNTC_API void cntc_getwheelsetvelocity(int *ire, int *count, double *values);
CNTC_API void cntc_getnumcontactpatches(int *ire, int *count);
CNTC_API void cntc_getcontactlocation(int *ire, int *icp, int *count, double *values);
CNTC_API void cntc_getglobalforces(int *ire, int *icp, int *count, double *values);
CNTC_API void cntc_getreferencevelocity(int *ire, int *icp, double *veloc);
CNTC_API void cntc_gethertzcontact(int *ire, int *icp, int *count, double *values);
CNTC_API void cntc_getnumelements(int *ire, int *icp, int *mx, int *my);
CNTC_API void cntc_getgriddiscretization(int *ire, int *icp, double *dx, double *dy);
CNTC_API void cntc_getpotcontact(int *ire, int *icp, int *count, double *values);
CNTC_API void cntc_getpenetration(int *ire, int *icp, double *pen);
CNTC_API void cntc_getcreepages(int *ire, int *icp, double *vx, double *vy, double *phi);
CNTC_API void cntc_getcontactforces(int *ire, int *icp, double *fn, double *tx, double *ty,
                                    double *mz);
CNTC_API void cntc_getcontactpatchareas(int *ire, int *icp, double *contact, double *adhesion,
                                        double *slip);
CNTC_API void cntc_getelementdivision(int *ire, int *icp, int *count, int *values);
CNTC_API void cntc_getmaximumpressure(int *ire, int *icp, double *value);
CNTC_API void cntc_getmaximumtraction(int *ire, int *icp, double *value);
CNTC_API void cntc_getmaximumtemperature(int *ire, int *icp, double *body1, double *body2);
CNTC_API void cntc_getfielddata(int *ire, int *icp, int *field, int *count, double *values);
CNTC_API void cntc_gettractions(int *ire, int *icp, int *count, double *pn, double *px, double *py);
CNTC_API void cntc_getmicroslip(int *ire, int *icp, int *count, double *sx, double *sy);
CNTC_API void cntc_getdisplacements(int *ire, int *icp, int *count, double *un, double *ux,
                                    double *uy);
CNTC_API void cntc_getsensitivities(int *ire, int *icp, int *nout, int *nin, double *values);
CNTC_API void cntc_getcalculationtime(int *ire, int *icp, double *cpu, double *wall);
CNTC_API void cntc_resetcalculationtime(int *ire, int *icp);
CNTC_API void subs_getblocksize(int *ire, int *icp, int *iblk, int *nx, int *ny, int *nz);
CNTC_API void subs_getresults(int *ire, int *icp, int *iblk, int *count, int *ncolumn, int *columns,
                              double *values);

#ifdef __cplusplus
}
#endif

#endif
