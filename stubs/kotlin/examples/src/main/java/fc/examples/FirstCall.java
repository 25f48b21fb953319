package fc.examples;

import fc.Client;
import fc.GetRobotSnRequest;
import fc.RechargeProgress;
import fc.runtime.CallError;
import fc.runtime.CallOptions;
import fc.runtime.ClientConfig;
import fc.runtime.ReceivedReport;
import java.util.concurrent.CompletionException;
import java.util.concurrent.TimeUnit;

/** The first call from Java: queries the serial number of the robot, and prints its reports. */
public final class FirstCall {
    private FirstCall() {}

    /**
     * Connects, asks and prints.
     *
     * @param arguments host and command port of the robot
     */
    public static void main(String[] arguments) {
        ClientConfig config =
                new ClientConfig().host(arguments[0]).commandPort(Integer.parseInt(arguments[1]));
        try (Client client = Client.connectAsync(config).join()) {
            client.getConnection().onReport(FirstCall::show);
            CallOptions soon = new CallOptions().timeout(5, TimeUnit.SECONDS);
            GetRobotSnRequest request = GetRobotSnRequest.builder().build();
            System.out.println(client.getRobotSnAsync(request, soon).join());
        } catch (CompletionException failure) {
            if (failure.getCause() instanceof CallError) {
                System.err.println(((CallError) failure.getCause()).getName());
            }
            System.exit(1);
        }
    }

    private static void show(ReceivedReport report) {
        if (report.getMessage() instanceof RechargeProgress) {
            System.out.println(report.getMessage());
        }
    }
}
