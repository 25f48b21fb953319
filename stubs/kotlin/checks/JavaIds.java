package user;

import java.util.Arrays;
import java.util.HashSet;
import meter.Band;
import meter.SetTariffRequest;
import meter.TariffId;

/** Ids in Java: they have constructors, and they are sent as their values. */
final class JavaIds {
    private JavaIds() {}

    public static void main(String[] arguments) {
        SetTariffRequest request = SetTariffRequest.builder()
                .band(Band.DAY).price(3L).note("x").tariff(new TariffId(5L)).others(Arrays.asList(new TariffId(8L))).build();
        String text = request.toJson().getText();
        check(text.contains("\"5\"") && text.contains("[8]"), text);
        check(request.equals(IdsKt.request().toBuilder().others(request.getOthers()).build()), "equal");
        check(request.getTariff().getValue() == 5L && request.getTariffOrDefault().toString().equals("5"), "value");
        check(new HashSet<>(Arrays.asList(new TariffId(5L), request.getTariff())).size() == 1, "hash");
    }

    private static void check(boolean holds, String what) {
        if (!holds) throw new AssertionError(what);
    }
}
