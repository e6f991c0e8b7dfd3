// Weka on the rows and folds of benches/classify.rs, which compiles and runs this against Debian's
// weka.jar (Weka 3.6.14):
//
//     java -cp /usr/share/java/weka.jar:DIR ClassifyWeka THREADS ROWS.csv...
//
// A file's columns: the label's letter, the eight features, and one column of fold numbers from 0 for each
// cross-validation, named fold<seed>. For each file, algorithm and cross-validation one line is printed:
//
//     file,algorithm,seed,right,rooms,log_loss,brier,cpu_ms
//
// cpu_ms is the processor time of training and testing all folds. The last line is the wall time of
// everything but reading: training and testing, on so many threads. Classifiers have Weka's defaults
// but for the number of neighbours.

import java.io.BufferedReader;
import java.io.FileReader;
import java.lang.management.ManagementFactory;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.Callable;
import java.util.concurrent.ExecutorService;
import java.util.concurrent.Executors;
import java.util.concurrent.Future;
import weka.classifiers.Classifier;
import weka.classifiers.functions.MultilayerPerceptron;
import weka.classifiers.lazy.IBk;
import weka.classifiers.rules.JRip;
import weka.classifiers.trees.J48;
import weka.core.Attribute;
import weka.core.FastVector;
import weka.core.Instance;
import weka.core.Instances;

public class ClassifyWeka {
    static final String LETTERS = "SMBCH";
    static final String[] ALGORITHMS = {"rules", "tree", "knn", "mlp"};
    static final double LEAST_PROBABILITY = 1e-9;

    static Classifier classifier(String algorithm) throws Exception {
        switch (algorithm) {
            case "rules": return new JRip();
            case "tree": return new J48();
            case "knn": {
                IBk knn = new IBk();
                knn.setKNN(5);
                return knn;
            }
            case "mlp": return new MultilayerPerceptron();
            default: throw new IllegalArgumentException(algorithm);
        }
    }

    static class Rows {
        String name;
        Instances instances;
        List<String> seeds = new ArrayList<>();
        List<int[]> folds = new ArrayList<>();
        int foldCount;
    }

    static Rows read(String path) throws Exception {
        Rows rows = new Rows();
        rows.name = path.substring(path.lastIndexOf('/') + 1).replaceAll("\\.csv$", "");
        List<String[]> lines = new ArrayList<>();
        try (BufferedReader reader = new BufferedReader(new FileReader(path))) {
            for (String line; (line = reader.readLine()) != null; ) {
                lines.add(line.split(","));
            }
        }
        String[] head = lines.remove(0);
        FastVector labels = new FastVector();
        for (char letter : LETTERS.toCharArray()) {
            labels.addElement(String.valueOf(letter));
        }
        FastVector attributes = new FastVector();
        for (int feature = 1; feature <= 8; feature++) {
            attributes.addElement(new Attribute(head[feature]));
        }
        attributes.addElement(new Attribute("label", labels));
        rows.instances = new Instances(rows.name, attributes, lines.size());
        rows.instances.setClassIndex(8);
        for (int column = 9; column < head.length; column++) {
            rows.seeds.add(head[column].substring("fold".length()));
            rows.folds.add(new int[lines.size()]);
        }
        for (int row = 0; row < lines.size(); row++) {
            String[] cells = lines.get(row);
            double[] values = new double[9];
            for (int feature = 0; feature < 8; feature++) {
                values[feature] = Double.parseDouble(cells[feature + 1]);
            }
            values[8] = LETTERS.indexOf(cells[0]);
            rows.instances.add(new Instance(1.0, values));
            for (int column = 9; column < head.length; column++) {
                int fold = Integer.parseInt(cells[column]);
                rows.folds.get(column - 9)[row] = fold;
                rows.foldCount = Math.max(rows.foldCount, fold + 1);
            }
        }
        return rows;
    }

    /** What one fold gives: right, rooms, sum of log losses, sum of Brier scores, milliseconds. */
    static double[] fold(Rows rows, String algorithm, int[] folds, int fold) throws Exception {
        long start = ManagementFactory.getThreadMXBean().getCurrentThreadCpuTime();
        Instances train = new Instances(rows.instances, 0);
        List<Instance> test = new ArrayList<>();
        for (int row = 0; row < folds.length; row++) {
            Instance instance = rows.instances.instance(row);
            if (folds[row] == fold) {
                test.add(instance);
            } else {
                train.add(instance);
            }
        }
        Classifier classifier = classifier(algorithm);
        classifier.buildClassifier(train);
        double[] sums = new double[5];
        for (Instance instance : test) {
            double[] distribution = classifier.distributionForInstance(instance);
            int truth = (int) instance.classValue();
            int given = 0;
            double squares = 0;
            for (int label = 0; label < distribution.length; label++) {
                squares += distribution[label] * distribution[label];
                if (distribution[label] > distribution[given]) {
                    given = label;
                }
            }
            sums[0] += given == truth ? 1 : 0;
            sums[1] += 1;
            sums[2] += -Math.log(Math.max(distribution[truth], LEAST_PROBABILITY));
            sums[3] += squares + 1 - 2 * distribution[truth];
        }
        sums[4] = (ManagementFactory.getThreadMXBean().getCurrentThreadCpuTime() - start) / 1e6;
        return sums;
    }

    public static void main(String[] arguments) throws Exception {
        int threads = Integer.parseInt(arguments[0]);
        List<Rows> files = new ArrayList<>();
        for (int index = 1; index < arguments.length; index++) {
            files.add(read(arguments[index]));
        }
        long start = System.nanoTime();
        ExecutorService pool = Executors.newFixedThreadPool(threads);
        List<String> heads = new ArrayList<>();
        List<List<Future<double[]>>> results = new ArrayList<>();
        for (Rows rows : files) {
            for (String algorithm : ALGORITHMS) {
                for (int column = 0; column < rows.folds.size(); column++) {
                    int[] folds = rows.folds.get(column);
                    List<Future<double[]>> parts = new ArrayList<>();
                    for (int fold = 0; fold < rows.foldCount; fold++) {
                        int part = fold;
                        Callable<double[]> task = () -> fold(rows, algorithm, folds, part);
                        parts.add(pool.submit(task));
                    }
                    heads.add(rows.name + "," + algorithm + "," + rows.seeds.get(column));
                    results.add(parts);
                }
            }
        }
        for (int index = 0; index < heads.size(); index++) {
            double[] sums = new double[5];
            for (Future<double[]> part : results.get(index)) {
                double[] of = part.get();
                for (int k = 0; k < 5; k++) {
                    sums[k] += of[k];
                }
            }
            System.out.printf("%s,%.0f,%.0f,%.5f,%.5f,%.1f%n", heads.get(index), sums[0], sums[1], sums[2] / sums[1],
                sums[3] / sums[1], sums[4]);
            System.out.flush();
        }
        pool.shutdown();
        System.out.printf("wall_ms,%.1f%n", (System.nanoTime() - start) / 1e6);
    }
}
