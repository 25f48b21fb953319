using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;

namespace FcTests
{
    /// <summary>Runs the golden frames, or decodes frames from standard input.</summary>
    public static class Program
    {
        /// <summary><c>vectors DIRECTORY CONFORMANCE</c> or <c>judge</c>.</summary>
        public static int Main(string[] arguments)
        {
            if (arguments.Length == 3 && arguments[0] == "vectors")
            {
                var report = new Report();
                Vectors.Run(arguments[1], report);
                Names.Run(Path.Combine(arguments[2], "errors.json"), report);
                Order.Run(Path.Combine(arguments[2], "faults.json"), report);
                return report.End();
            }
            if (arguments.Length == 1 && arguments[0] == "judge")
            {
                Judge.Run(Console.In, Console.Out);
                return 0;
            }
            Console.Error.WriteLine("usage: vectors DIRECTORY CONFORMANCE | judge");
            return 2;
        }
    }

    /// <summary>Counts passed cases and prints failed ones.</summary>
    public sealed class Report
    {
        private readonly SortedDictionary<string, int> kinds = new SortedDictionary<string, int>();
        private int held;
        private int failed;

        /// <summary>
        /// Runs one case. It passes if its result is <c>expected</c>: a text, or the name of a <see
        /// cref="FcRuntime.Fault"/>. It counts for <c>kind</c> of <c>conformance/README.md</c>, if given.
        /// </summary>
        public void Case(string kind, string name, string expected, Func<string> run)
        {
            string found;
            try
            {
                found = run();
            }
            catch (FcRuntime.Fault fault)
            {
                found = fault.Name;
            }
            catch (Exception error)
            {
                found = error.ToString();
            }
            if (found == expected)
            {
                held++;
                if (kind != null)
                {
                    kinds[kind] = kinds.TryGetValue(kind, out var before) ? before + 1 : 1;
                }
                return;
            }
            failed++;
            Console.WriteLine("FAILED " + name + "\n  expected " + expected + "\n  found    " + found);
        }

        /// <summary>
        /// Prints the figures. Appends a line <c>KIND NUMBER</c> for each kind to the file that FC_CONFORMANCE names.
        /// Returns 0 if all cases passed and there was at least one.
        /// </summary>
        public int End()
        {
            var told = Environment.GetEnvironmentVariable("FC_CONFORMANCE");
            if (!string.IsNullOrEmpty(told))
            {
                File.AppendAllText(told, string.Concat(kinds.Select(kind => kind.Key + " " + kind.Value + "\n")));
            }
            Console.WriteLine(held + " cases hold, " + failed + " do not");
            return failed == 0 && held > 0 ? 0 : 1;
        }
    }
}
