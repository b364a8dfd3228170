// 100 steps of an FMU in FMI4j: java -cp ... WithFmi4j.java NAME.fmu
import java.io.File;
import java.util.ArrayList;
import java.util.List;
import no.ntnu.ihb.fmi4j.SlaveInstance;
import no.ntnu.ihb.fmi4j.importer.fmi2.Fmu;
import no.ntnu.ihb.fmi4j.modeldescription.variables.Causality;
import no.ntnu.ihb.fmi4j.modeldescription.variables.TypedScalarVariable;
import no.ntnu.ihb.fmi4j.modeldescription.variables.VariableType;

public class WithFmi4j {
  static final double STEP = 1e-3;

  public static void main(String[] arguments) throws Exception {
    try (Fmu fmu = Fmu.from(new File(arguments[0]));
        SlaveInstance slave = fmu.asCoSimulationFmu().newInstance("contact")) {
      TypedScalarVariable<?> moved = null;
      List<TypedScalarVariable<?>> outputs = new ArrayList<>();
      for (TypedScalarVariable<?> v : slave.getModelDescription().getModelVariables()) {
        if (v.getType() != VariableType.REAL) continue;
        if (v.getCausality() == Causality.OUTPUT) outputs.add(v);
        if (v.getCausality() == Causality.INPUT && moved == null) moved = v;
      }
      double start = (Double) moved.getStart();
      slave.setupExperiment(0.0, 0.0, 0.0);
      slave.enterInitializationMode();
      slave.exitInitializationMode();
      long[] reference = {moved.getValueReference()};
      for (int k = 0; k < 100; ++k) {
        if (!slave.writeReal(reference, new double[] {start + 1e-8 * k}).isOK())
          throw new IllegalStateException("set " + k);
        if (!slave.doStep(k * STEP, STEP)) throw new IllegalStateException("step " + k);
      }
      double[] value = new double[1];
      for (TypedScalarVariable<?> v : outputs) {
        slave.readReal(new long[] {v.getValueReference()}, value);
        if (value[0] != 0.0) System.out.printf("  %-28s%.15g%n", v.getName(), value[0]);
      }
      slave.terminate();
    }
  }
}
